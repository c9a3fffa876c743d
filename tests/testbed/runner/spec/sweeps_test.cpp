// Sweeps and the cases that they make.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SpecSweeps : public SpecTest {};

TEST_F(SpecSweeps, SweepWithoutGridMakesItsCasesBesideTheBase) {
  const Experiment e = load(toy::disc_experiment() + kSweep +
                            "[[sweep]]\nkey = \"seed\"\nvalues = [4, 5]\nnames = [\"a\", \"b\"]\n");
  EXPECT_THAT(case_names(e), ElementsAre("default", "segments=8", "segments=32", "a", "b"));
  EXPECT_EQ(options(e, 2, 1)["segments"], 32);
  EXPECT_EQ(options(e, 3, 1)["segments"], 16);
  EXPECT_EQ(e.cases[4].seed, 5U);
  EXPECT_EQ(e.cases[2].swept.at("variant.polygon.options.segments"), "32");
}

TEST_F(SpecSweeps, GridSweepsMakeTheirProduct) {
  const std::string grid = "grid = true\nbase = false\n";
  const Experiment e = load(toy::disc_experiment() + kSweep + grid +
                            "[[sweep]]\nkey = \"scene.points\"\nvalues = [6, 12, 18]\n" + grid);
  ASSERT_EQ(e.cases.size(), 6U);
  EXPECT_EQ(e.cases[4].name, "segments=32,points=12");
  EXPECT_EQ(options(e, 4, 1)["segments"], 32);
  EXPECT_EQ(json::parse(e.cases[4].scene_json)["points"], 12);
}

TEST_F(SpecSweeps, SweepsForClaimsOnlySayThatOfTheirCases) {
  const Experiment e = load(toy::disc_experiment() + kSweep +
                            "[[sweep]]\nkey = \"seed\"\nvalues = [7]\nclaims_only = true\n");
  for (const CaseSpec& made : e.cases) EXPECT_EQ(made.claims_only, made.name == "seed=7");
}

TEST_F(SpecSweeps, QuickValuesThatStandInOneForOneKeepTheNames) {
  const std::string sweep = toy::disc_experiment() +
                            "[[sweep]]\nkey = \"seed\"\nvalues = [4, 5]\nnames = [\"a\", \"b\"]\n";
  EXPECT_THAT(case_names(load(sweep + "quick_values = [6, 7]\n", sized(true))),
              ElementsAre("default", "a", "b"));
  EXPECT_THAT(case_names(load(sweep + "quick_values = [6]\n", sized(true))),
              ElementsAre("default", "seed=6"));
}

TEST_F(SpecSweeps, SweepsOfOneNameAreToldApartAndRepeatedCasesRefused) {
  const std::string two =
      "[[variant]]\nname = \"other\"\nmethod = \"polygon\"\n"
      "[[sweep]]\nkey = \"variant.polygon.options.segments\"\nvalues = [8]\n"
      "[[sweep]]\nkey = \"variant.other.options.segments\"\nvalues = [8]\n";
  const auto names = case_names(load(toy::disc_experiment() + two));
  EXPECT_THAT(names, ElementsAre("default", "variant.polygon.options.segments=8",
                                 "variant.other.options.segments=8"));
  EXPECT_THAT(error_of(toy::disc_experiment() + "[[sweep]]\nkey = \"seed\"\nvalues = [1, 1]\n"),
              HasSubstr("two cases are called"));
  EXPECT_THAT(error_of(toy::disc_experiment() + "[[sweep]]\nkey = \"title\"\nvalues = [1]\n"),
              HasSubstr("cannot be swept"));
}

}  // namespace
}  // namespace geoprior::test
