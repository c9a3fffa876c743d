#include "solvers/embryo/rules/effects.h"

#include <gtest/gtest.h>

#include "solvers/embryo/rules/closure.h"
#include "tests/embryo/rules/ontology_files.h"

namespace geoprior::embryo {
namespace {

/// Bud (stages 0, 1) is made by Budding; System has the part Bud and no interval; Isthmus is made
/// by Fusion, which is dormant.
Ontology bud_ontology() {
  Ontology ontology;
  for (const char* name : {"S1", "S2", "S3"}) {
    Stage stage;
    stage.name = name;
    ontology.stages.push_back(stage);
  }
  Structure bud, isthmus, system;
  bud.name = "Bud";
  bud.from_stage = 0;
  bud.until_stage = 1;
  bud.part_of = {2};
  isthmus.name = "Isthmus";
  isthmus.from_stage = 1;
  isthmus.until_stage = 2;
  system.name = "System";
  ontology.structures = {bud, isthmus, system};
  ProcessEntry budding, fusion;
  budding.name = "Budding";
  budding.produces = {0};
  fusion.name = "Fusion";
  fusion.produces = {1};
  fusion.dormant = true;
  ontology.processes = {budding, fusion};
  Disease agenesis, horseshoe;
  agenesis.name = "Agenesis";
  agenesis.disables = {0};
  horseshoe.name = "Horseshoe";
  horseshoe.enables = {1};
  ontology.diseases = {agenesis, horseshoe};
  return ontology;
}

const std::string kBudTriples =
    "e:S1 a e:TemporalEntity ; e:order 1 . e:S2 a e:TemporalEntity ; e:order 2 .\n"
    "e:S3 a e:TemporalEntity ; e:order 3 .\n"
    "e:Bud e:existsFrom e:S1 ; e:existsUntil e:S2 ; e:partOf e:System .\n"
    "e:Isthmus e:existsFrom e:S2 ; e:existsUntil e:S3 .\n"
    "e:Budding a e:Growth ; e:produces e:Bud .\n"
    "e:Fusion a e:Interaction ; e:produces e:Isthmus ; e:dormant true .\n"
    "e:Agenesis a e:Disease ; e:disables e:Budding . e:Horseshoe a e:Disease ; e:enables e:Fusion "
    ".";

using Flags = std::vector<bool>;

Effects effects_under(const std::optional<std::string>& disease) {
  const Graph graph = test::small_graph(kBudTriples);
  return effects_of(test::developed(graph, disease), graph, bud_ontology());
}

TEST(Effects, AreWhatTheRulesSay) {
  const Effects healthy = effects_under(std::nullopt);
  EXPECT_EQ(healthy.inactive, (Flags{false, true}));
  EXPECT_EQ(healthy.absent, (Flags{false, true, false}));
  EXPECT_EQ(healthy.exists,
            (std::vector<Flags>{{true, true, false}, {false, false, false}, {true, true, false}}));
  const Effects sick = effects_under("Agenesis");
  EXPECT_EQ(sick.absent, (Flags{true, true, false}));
  EXPECT_EQ(sick.exists[2], (Flags{false, false, false}));
  EXPECT_EQ(effects_under("Horseshoe").exists[1], (Flags{false, true, true}));
}

TEST(Effects, WithoutRulesStopAtWhatTheDiseaseNames) {
  const Ontology ontology = bud_ontology();
  const Effects healthy = effects_without_rules(ontology, std::nullopt);
  EXPECT_EQ(healthy.inactive, (Flags{false, true}));
  const Effects sick = effects_without_rules(ontology, 0);
  EXPECT_EQ(sick.inactive, (Flags{true, true}));
  EXPECT_EQ(sick.absent, (Flags{false, false, false}));
  EXPECT_EQ(sick.exists, healthy.exists);
  EXPECT_EQ(sick.exists[2], (Flags{true, true, false}));
  EXPECT_EQ(effects_without_rules(ontology, 1).inactive, (Flags{false, false}));
}

}  // namespace
}  // namespace geoprior::embryo
