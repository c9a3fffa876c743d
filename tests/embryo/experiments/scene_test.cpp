// Scenes of the ontology of the repository, and what is refused.
#include "experiments/embryo/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "core/error.h"
#include "solvers/embryo/state/development.h"
#include "testbed/home.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::embryo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path embryo_folder() { return geoprior_home() / "experiments/embryo"; }

std::string refusal_of(const EmbryoSceneOptions& options) {
  try {
    load_embryo_scene(options, embryo_folder());
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(EmbryoScene, OursHasNoViolationAndAllClassesInUse) {
  const auto scene = load_embryo_scene({}, embryo_folder());
  for (const Violation& one : scene->violations) ADD_FAILURE() << one.message;
  std::set<int> primitives, processes;
  for (const Structure& one : scene->ontology.structures)
    for (const Key& key : one.keys) primitives.insert(static_cast<int>(key.geometry.primitive));
  for (const ProcessEntry& one : scene->ontology.processes) {
    if (!one.acts_on.empty()) processes.insert(static_cast<int>(one.kind));
  }
  EXPECT_EQ(primitives.size(), 6u);
  EXPECT_EQ(processes.size(), 6u);
  EXPECT_GE(scene->ontology.structures.size(), 25u);
  EXPECT_EQ(scene->ontology.diseases.size(), 9u);
}

TEST(EmbryoScene, DaysOutsideTheDataNameTheRange) {
  EmbryoSceneOptions options;
  options.days = {44, 120};
  EXPECT_THAT(refusal_of(options),
              AllOf(HasSubstr("scene.days.1"), HasSubstr("day 120"), HasSubstr(" to ")));
  options = {};
  options.to_day = 500;
  EXPECT_THAT(refusal_of(options), HasSubstr("scene.to_day"));
  options = {};
  options.from_day = 50;
  options.to_day = 40;
  EXPECT_THAT(refusal_of(options), HasSubstr("scene.from_day"));
}

TEST(EmbryoScene, UnknownNamesAreErrorsWithWhatIsAllowed) {
  EmbryoSceneOptions options;
  options.disease = "RenalAgenesis";
  EXPECT_THAT(refusal_of(options),
              AllOf(HasSubstr("scene.disease"), HasSubstr("RenalAgenesisLeft")));
  options = {};
  options.only = {"LeftMetanefros"};
  EXPECT_THAT(refusal_of(options), AllOf(HasSubstr("scene.only"), HasSubstr("LeftMetanephros")));
  options = {};
  options.parameter_set = "Descent";
  EXPECT_THAT(refusal_of(options), HasSubstr("Descent"));
  options = {};
  options.ontology = "nowhere.ttl";
  EXPECT_THAT(refusal_of(options), AllOf(HasSubstr("scene.ontology"), HasSubstr("nowhere.ttl")));
  options = {};
  options.rules = "urinary.toml";
  EXPECT_THAT(refusal_of(options), HasSubstr("urinary.toml:"));
}

TEST(EmbryoScene, CopiesAreAsManyMoreTriples) {
  EmbryoSceneOptions options;
  const auto one = load_embryo_scene(options, embryo_folder());
  options.copies = 3;
  const auto three = load_embryo_scene(options, embryo_folder());
  EXPECT_GT(three->graph.size(), 2.9 * one->graph.size()) << "stages and sources are common";
  EXPECT_LT(three->graph.size(), 3 * one->graph.size());
  EXPECT_FALSE(three->graph.dictionary().find_local("CS17_3").has_value());
  EXPECT_TRUE(three->graph.dictionary().find_local("LeftUreter_3").has_value());
}

TEST(EmbryoScene, AUsersBudAppearsGrowsAndIsNoDisease) {
  EmbryoSceneOptions options;
  options.additions = {"bud.ttl"};
  const auto base = load_embryo_scene({}, embryo_folder());
  const auto scene = load_embryo_scene(options, embryo_folder());
  ASSERT_EQ(scene->ontology.structures.size(), base->ontology.structures.size() + 1);
  int bud = -1;
  for (std::size_t i = 0; i < scene->ontology.structures.size(); ++i)
    if (!base->ontology.find_structure(scene->ontology.structures[i].name))
      bud = static_cast<int>(i);
  const Structure& structure = scene->ontology.structures[bud];
  const Development development(scene->ontology, scene->effects, {});
  const auto size_at = [&](double day) {
    for (const StructureState& one : development.at(day).structures)
      if (one.structure == bud) return one.shape.radius + one.shape.radii.maxCoeff();
    return 0.0;
  };
  const double first = scene->ontology.stages[*structure.from_stage].start_day;
  const double last = scene->ontology.stages[*structure.until_stage].middle();
  EXPECT_EQ(size_at(first - 0.5), 0) << "before its first stage";
  EXPECT_GT(size_at(first + 0.5), 0);
  EXPECT_GT(size_at(last), size_at(first + 0.5));
}

TEST(EmbryoScene, ASecondSystemIsAFileOfItsOwn) {
  EmbryoSceneOptions options;
  options.ontology = "limb.ttl";
  options.parameter_set = "";
  const auto scene = load_embryo_scene(options, embryo_folder());
  EXPECT_TRUE(scene->violations.empty());
  const Development development(scene->ontology, scene->effects, {});
  EXPECT_GE(development.at(scene->days.back()).structures.size(), 3u);
}

TEST(EmbryoScene, MistakesAreErrorsUnlessTheyAreToBeCounted) {
  EmbryoSceneOptions options;
  options.ontology = "limb.ttl";
  options.parameter_set = "";
  options.additions = {"drawing.ttl"};
  EXPECT_THAT(refusal_of(options), AllOf(HasSubstr("drawing.ttl:7: "), HasSubstr("and 3 more")));
  options.count_mistakes = true;
  const auto scene = load_embryo_scene(options, embryo_folder());
  std::set<ViolationKind::Theme> themes;
  for (const Violation& one : scene->violations) themes.insert(violation_kind(one.kind).theme);
  EXPECT_EQ(scene->violations.size(), 4u);
  EXPECT_EQ(themes.size(), 4u) << "one of each";
}

TEST(EmbryoScene, QueriesAreReadFromTheFolderNamed) {
  EXPECT_TRUE(load_embryo_scene({}, embryo_folder())->files.queries.empty());
  EmbryoSceneOptions options;
  options.queries = "queries";
  EXPECT_EQ(load_embryo_scene(options, embryo_folder())->files.queries.size(), 8u);
  options.queries = "rules";
  EXPECT_THAT(refusal_of(options), AllOf(HasSubstr("scene.queries"), HasSubstr("q1.rq")));
}

class EmbryoFiles : public test::RunTest {};

TEST_F(EmbryoFiles, ExpectedListsAreHeldAgainstTheirKeys) {
  const fs::path file = folder() / "mine.toml";
  std::ofstream(file) << "[A]\nabsent = [\"x\"]\n[B]\nabsnt = []\n";
  EXPECT_EQ(read_expected_changes(file, "A").absent, std::vector<std::string>{"x"});
  EXPECT_THROW(read_expected_changes(file, "B"), Error);
  EXPECT_THROW(read_expected_changes(file, "C"), Error);
}

}  // namespace
}  // namespace geoprior::embryo
