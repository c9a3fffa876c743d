#include "models/embryo/ontology/ontology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "tests/embryo/ontology/planted.h"
#include "tests/embryo/ontology/small_ontology.h"

namespace geoprior::embryo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Ontology small_one(const OntologySelection& selection = {}) {
  return test::read_ontology(test::small_ontology(), selection);
}

std::string small_refusal(const std::string& text, const OntologySelection& selection = {}) {
  try {
    test::read_ontology(text, selection);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

const Structure& small_structure(const Ontology& ontology, const std::string& name) {
  return ontology.structures[ontology.find_structure(name).value()];
}

std::vector<std::string> small_key_names(const Structure& structure) {
  std::vector<std::string> names;
  for (const Key& key : structure.keys) names.push_back(key.name);
  return names;
}

TEST(Ontology, OrdersStagesByOrderAndTheRestByName) {
  const Ontology ontology = small_one();
  ASSERT_EQ(ontology.stages.size(), 4u);
  EXPECT_EQ(ontology.stages[1].name, "S2");
  EXPECT_EQ(ontology.stages[1].middle(), 14);
  EXPECT_EQ(ontology.find_stage("S4"), 3);
  for (std::size_t i = 1; i < ontology.structures.size(); ++i)
    EXPECT_LT(ontology.structures[i - 1].name, ontology.structures[i].name);
  EXPECT_THAT(ontology.parameter_sets, ElementsAre("Fast", "Slow"));
}

TEST(Ontology, GivesLengthsInMetresAndAnglesInRadians) {
  const Ontology ontology = small_one({.parameter_set = "Fast"});
  const Structure& kidney = small_structure(ontology, "Kidney");
  EXPECT_NEAR((kidney.keys[0].geometry.radii - Eigen::Vector3d(2e-4, 2e-4, 4e-4)).norm(), 0, 1e-15);
  EXPECT_NEAR((kidney.keys[1].geometry.radii - Eigen::Vector3d(4e-4, 4e-4, 8e-4)).norm(), 0, 1e-15);
  EXPECT_NEAR(ontology.processes[ontology.find_process("Turning").value()].angle,
              std::numbers::pi / 2, 1e-15);
  ASSERT_EQ(ontology.crown_rump_length.size(), 2u);
  EXPECT_EQ(ontology.crown_rump_length[0].first, 11);
  EXPECT_NEAR(ontology.crown_rump_length[0].second, 0.01, 1e-15);
  EXPECT_NEAR(ontology.crown_rump_length[1].second, 0.02, 1e-15);
}

TEST(Ontology, TakesTheKeysOfTheChosenSet) {
  EXPECT_THAT(small_key_names(small_structure(small_one(), "Kidney")),
              ElementsAre("KidneyS2", "KidneyS4"));
  EXPECT_THAT(small_key_names(small_structure(small_one({.parameter_set = "Slow"}), "Kidney")),
              ElementsAre("KidneyS2", "KidneyS3", "KidneyS4"));
}

TEST(Ontology, LeavesProcessesOfOtherSetsOut) {
  const Ontology slow = small_one({.parameter_set = "Slow"});
  EXPECT_FALSE(slow.find_process("Turning"));
  const int rising = slow.find_process("Rising").value();
  EXPECT_THAT(slow.diseases[0].disables, ElementsAre(rising));
  EXPECT_THAT(slow.processes[rising].requires_, ElementsAre(*slow.find_process("Growing")));
  const Ontology fast = small_one({.parameter_set = "Fast"});
  EXPECT_THAT(fast.diseases[0].disables,
              ElementsAre(*fast.find_process("Rising"), *fast.find_process("Turning")));
}

TEST(Ontology, MovesWhatIsOfTheSetByAShift) {
  const Ontology slow = small_one({.parameter_set = "Slow", .stage_shift = 1});
  // The key of the set falls on the common one of the last stage, which it replaces.
  EXPECT_THAT(small_key_names(small_structure(slow, "Kidney")),
              ElementsAre("KidneyS2", "KidneyS3"));
  EXPECT_EQ(small_structure(slow, "Kidney").keys[1].day, 22);
  const Ontology fast = small_one({.parameter_set = "Fast", .stage_shift = 3});
  const ProcessEntry& turning = fast.processes[*fast.find_process("Turning")];
  EXPECT_EQ(turning.to_stage, 3);
  EXPECT_EQ(turning.from_stage, 2) << "a span stays a span";
  EXPECT_THAT(small_refusal(test::small_ontology(), {.parameter_set = "Slow", .stage_shift = 4}),
              HasSubstr("a shift by 4 stages (allowed: 0 to 3)"));
}

TEST(Ontology, MakesUpPerpendicularToTheAxis) {
  const Geometry geometry = small_structure(small_one(), "Kidney").keys[0].geometry;
  EXPECT_NEAR((geometry.up - Eigen::Vector3d(-1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR(geometry.axis.dot(geometry.up), 0, 1e-15);
}

TEST(Ontology, ReadsTheEndsAndControlPointsOfADuct) {
  const Ontology ontology = small_one();
  const Geometry duct = small_structure(ontology, "Ureter").keys[0].geometry;
  EXPECT_EQ(duct.primitive, Primitive::duct);
  EXPECT_EQ(duct.start.structure, ontology.find_structure("Cloaca"));
  EXPECT_EQ(duct.end.structure, ontology.find_structure("Kidney"));
  EXPECT_EQ(duct.end.at.x(), 0.5);
  ASSERT_EQ(duct.via.size(), 2u);
  EXPECT_EQ(duct.via[1].z(), 0.3);
  EXPECT_EQ(duct.end_radius, duct.radius);
  EXPECT_EQ(duct.branchings, 2);
}

TEST(Ontology, GivesMeasurementsARangeAndAMean) {
  const Ontology ontology = small_one();
  ASSERT_EQ(ontology.measurements.size(), 2u);
  const Measurement &angle = ontology.measurements[0], &length = ontology.measurements[1];
  constexpr double kDegree = std::numbers::pi / 180;
  EXPECT_NEAR(angle.low, 60 * kDegree, 1e-15);
  EXPECT_NEAR(angle.high, 120 * kDegree, 1e-15);
  EXPECT_EQ(angle.unit, "rad");
  EXPECT_NEAR(length.mean, 1.2e-3, 1e-15);
  EXPECT_NEAR(length.deviation, 2e-4, 1e-15);
  EXPECT_EQ(length.source, "Drawn");
  EXPECT_THAT(length.input_of, ElementsAre("Slow"));
}

TEST(Ontology, IsTheSameFromItsNTriples) {
  const Graph graph = read_graph(test::small_ontology(), RdfFormat::turtle, "small.ttl");
  const Graph again = read_graph(to_ntriples(graph), RdfFormat::ntriples, "small.nt");
  const Ontology a = make_ontology(graph, {}, "a"), b = make_ontology(again, {}, "b");
  ASSERT_EQ(a.structures.size(), b.structures.size());
  for (std::size_t i = 0; i < a.structures.size(); ++i) {
    EXPECT_EQ(a.structures[i].name, b.structures[i].name);
    EXPECT_EQ(small_key_names(a.structures[i]), small_key_names(b.structures[i]));
  }
}

TEST(Ontology, RefusesTheFirstViolationWithItsLine) {
  std::string text = test::small_ontology();
  text.replace(text.find("e:unit \"deg\""), 12, "e:unit \"mm\" ");
  const auto line = 1 + std::count(text.begin(), text.begin() + text.find("e:Turning a"), '\n');
  EXPECT_EQ(small_refusal(text),
            "small.ttl:" + std::to_string(line) + ": 'Turning' has no unit of its angle");
}

TEST(Ontology, RefusesASetThatIsNotThere) {
  EXPECT_EQ(small_refusal(test::small_ontology(), {.parameter_set = "Quick"}),
            "small.ttl: no parameter set 'Quick' (allowed: Fast, Slow)");
  EXPECT_THAT(small_refusal(""), HasSubstr("no stage"));
}

}  // namespace
}  // namespace geoprior::embryo
