// What a run leaves out of its file, and what is claimed and drawn of that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testbed/runner/spec/spec_fixture.h"

namespace geoprior::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

class SpecLeftOut : public SpecTest {};

TEST_F(SpecLeftOut, QuickVersionLeavesOutWhatOnlyTheFullOneHas) {
  const auto claim = [](const std::string& text) {
    return "[[claim]]\ntext = \"" + text +
           "\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = " +
           std::to_string(text.size()) + "\n";
  };
  const std::string both =
      "except = [{ cases = [\"segments=8\", \"segments=32\"], reason = \"coarse\" }]\n";
  const std::string full = "except = [{ cases = [\"segments=32\"], reason = \"fine\" }]\n";
  const std::string text = toy::disc_experiment() + kSweep + claim("both") + both + claim("whole") +
                           full + "[[sweep]]\nkey = \"seed\"\nvalues = [4]\nquick_values = []\n";
  EXPECT_EQ(load(text).claims.size(), 2U);
  const Experiment quick = load(text, sized(true));
  EXPECT_THAT(case_names(quick), ElementsAre("default", "segments=8"));
  ASSERT_EQ(quick.claims.size(), 2U) << "a claim is decided in what there is";
  EXPECT_THAT(quick.claims[0].except, ElementsAre(Pair("segments=8", "coarse")));
  EXPECT_TRUE(quick.claims[1].except.empty());
  // What a run writes down of itself can be read again.
  const Experiment again = load(quick.resolved_toml);
  EXPECT_EQ(case_names(again), case_names(quick));
  EXPECT_EQ(again.claims.size(), 2U);
  EXPECT_EQ(again.claims.at(0).except, quick.claims[0].except);
  const std::string none = "except = [{ cases = [\"segments=9\"], reason = \"odd\" }]\n";
  EXPECT_THAT(error_of(text + claim("another") + none, sized(true)), HasSubstr("segments=9"));
}

TEST_F(SpecLeftOut, SweepsAreTakenOutWithWhatIsClaimedOfThem) {
  const std::string claim = "[[claim]]\nmetric = \"radius_error\"\nvariant = \"polygon\"\n";
  const std::string seeds = "[[sweep]]\nkey = \"seed\"\nvalues = [4, 5]\n";
  const std::string text =
      toy::disc_experiment() + kSweep + seeds + claim +
      "text = \"of 9 of 10 seeds\"\nvalue = 1\nover = \"seed\"\n" + claim +
      "text = \"of all but one\"\nvalue = 2\nexcept = [{ cases = [\"segments=32\"], "
      "reason = \"fine\" }]\n" +
      claim + "text = \"of the file\"\nvalue = 3\n";
  LoadRequest alone;
  alone.sets = {"sweep=[]"};
  const Experiment one = load(text, alone);
  EXPECT_THAT(case_names(one), ElementsAre("default"));
  ASSERT_EQ(one.claims.size(), 2U) << "one seed decides no claim over seeds";
  EXPECT_EQ(one.claims[0].text, "of all but one");
  EXPECT_TRUE(one.claims[0].except.empty());
  EXPECT_EQ(load(one.resolved_toml).claims.size(), 2U);
  alone.sets = {"sweep=[1]"};
  EXPECT_THAT(error_of(text, alone), HasSubstr("sweeps can only be taken out"));
}

TEST_F(SpecLeftOut, QuickVersionLeavesOutClaimsThatItIsTooShortFor) {
  const auto claim = [](const std::string& text, const std::string& more) {
    return "[[claim]]\ntext = \"" + text +
           "\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = " +
           std::to_string(text.size()) + "\n" + more;
  };
  const std::string text =
      toy::disc_experiment() + claim("both", "") + claim("only long", "quick = false\n");
  EXPECT_EQ(load(text).claims.size(), 2U);
  const Experiment quick = load(text, sized(true));
  ASSERT_EQ(quick.claims.size(), 1U);
  EXPECT_EQ(quick.claims[0].text, "both");
  EXPECT_THAT(error_of(toy::disc_experiment() + claim("no", "quick = 0\n"), sized(true)),
              HasSubstr("quick"));
}

TEST_F(SpecLeftOut, QuickVersionLeavesOutVariants) {
  const auto claim = [](const std::string& more) {
    return "[[claim]]\ntext = \"t\"\nmetric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\n" +
           more;
  };
  const std::string octagon =
      "[[variant]]\nname = \"octagon\"\nmethod = \"polygon\"\nquick = false\n";
  const std::string sweep =
      "[[sweep]]\nkey = \"seed\"\nvalues = [2]\nvariants = [\"exact\", \"octagon\"]\n"
      "[[sweep]]\nkey = \"scene.radius_m\"\nvalues = [3]\nvariants = [\"octagon\"]\n";
  const std::string text = toy::disc_experiment() + octagon + sweep;
  const Experiment full = load(text);
  EXPECT_EQ(full.cases[0].variants.size(), 3U);
  EXPECT_EQ(full.cases.size(), 3U);
  const Experiment quick = load(text + claim(""), sized(true));
  EXPECT_EQ(quick.cases[0].variants.size(), 2U);
  EXPECT_THAT(case_names(quick), ElementsAre("default", "seed=2"));
  EXPECT_EQ(load(quick.resolved_toml).hash, quick.hash) << "an experiment file itself";
  const std::string view =
      "[figure_view]\nvariants = [\"exact\", \"octagon\"]\ncases = [\"default\", \"radius_m=3\"]\n";
  const FigureView shown =
      figure_view_of(load(text + view, sized(true)).resolved_toml, "", topics_);
  EXPECT_THAT(shown.variants, ElementsAre("exact"));
  EXPECT_THAT(shown.cases, ElementsAre("default"));
  LoadRequest named = sized(true);
  named.variants = {"octagon"};
  EXPECT_EQ(load(text, named).cases[0].variants[0].name, "octagon");

  EXPECT_THAT(error_of(text + claim("null = \"octagon\"\n"), sized(true)),
              AllOf(HasSubstr("quick runs leave variant 'octagon' out"), HasSubstr("null"),
                    HasSubstr("`quick = false` of the claim")));
  EXPECT_EQ(load(text + claim("null = \"octagon\"\nquick = false\n"), sized(true)).claims.size(),
            0U);
  EXPECT_EQ(load(text + claim("null = \"octagon\"\n")).claims.size(), 1U);
  const std::string study =
      "[[study]]\nname = \"growth\"\nkind = \"exponent\"\nvariant = \"octagon\"\n"
      "quantity = \"radius_error\"\nagainst = \"seed\"\n"
      "[[claim]]\ntext = \"s\"\nmetric = \"study:growth\"\nvalue = 1\n";
  EXPECT_THAT(error_of(text + study, sized(true)),
              HasSubstr("quick runs leave variant 'octagon' out"));
  EXPECT_THAT(
      error_of(text + "[[variant]]\nname = \"x\"\nmethod = \"polygon\"\nreference = \"octagon\"\n"),
      AllOf(HasSubstr("variant 'octagon' is left out of quick runs"), HasSubstr("reference")));
  std::string none = toy::disc_experiment();
  for (std::size_t at = 0; (at = none.find("[[variant]]\n", at)) != std::string::npos; at += 30) {
    none.insert(at + 12, "quick = false\n");
  }
  EXPECT_THAT(error_of(none), HasSubstr("has no variant of quick runs"));
}

/// Sweeps about variants that are left out: what was run is what the text says that it is.
TEST_F(SpecLeftOut, LeavesOutSweepsOfVariantsThatAreLeftOut) {
  const auto sweep = [](const std::string& key, const std::string& variants,
                        const std::string& more) {
    return "[[sweep]]\nkey = \"" + key + "\"\nvalues = [3, 4]\nvariants = [" + variants + "]\n" +
           more;
  };
  const std::string octagon =
      "[[variant]]\nname = \"octagon\"\nmethod = \"polygon\"\nquick = false\n";
  const auto cases_of = [&](const std::string& sweeps) {
    const Experiment quick = load(toy::disc_experiment() + octagon + sweeps, sized(true));
    const Experiment again = load(quick.resolved_toml);
    EXPECT_EQ(case_names(again), case_names(quick)) << sweeps;
    EXPECT_EQ(again.hash, quick.hash) << sweeps;
    return case_names(quick);
  };
  const std::string grid = "grid = true\n", no_base = "base = false\n";
  EXPECT_THAT(cases_of(sweep("seed", "\"octagon\"", no_base)), ElementsAre("default"));
  EXPECT_THAT(
      cases_of(sweep("seed", "\"octagon\"", grid) + sweep("scene.radius_m", "\"octagon\"", grid)),
      ElementsAre("default"));
  EXPECT_THAT(
      cases_of(sweep("seed", "\"octagon\"", grid) + sweep("scene.radius_m", "\"exact\"", grid)),
      ElementsAre("default", "seed=3,radius_m=3", "seed=3,radius_m=4", "seed=4,radius_m=3",
                  "seed=4,radius_m=4"));
}

TEST_F(SpecLeftOut, VariantSelectionKeepsReferencesAndDropsClaimsAboutOthers) {
  const std::string claims =
      "[[claim]]\ntext = \"a\"\nmetric = \"radius_error\"\nvariant = \"polygon\"\nvalue = 1\n"
      "[[claim]]\ntext = \"b\"\nmetric = \"radius_error\"\nvariant = \"exact\"\nvalue = 1\n";
  const std::string text = toy::disc_experiment() + kSweep + claims;
  const Experiment exact = load(text, only({"exact"}));
  ASSERT_EQ(exact.cases.size(), 1U) << "the sweep of the other variant's option is left out";
  EXPECT_EQ(exact.cases[0].variants.size(), 1U);
  ASSERT_EQ(exact.claims.size(), 1U);
  EXPECT_EQ(exact.claims[0].text, "b");
  EXPECT_EQ(load(text, only({"polygon"})).cases[0].variants.size(), 2U);
  EXPECT_THAT(error_of(text, only({"exakt"})), HasSubstr("did you mean 'exact'"));
}

}  // namespace
}  // namespace geoprior::test
