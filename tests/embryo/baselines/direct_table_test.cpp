#include "baselines/embryo/direct_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "core/error.h"
#include "solvers/embryo/ontology/read_ontology.h"
#include "solvers/embryo/rules/closure.h"
#include "solvers/embryo/rules/program.h"
#include "solvers/embryo/state/development.h"
#include "solvers/embryo/triples/read.h"

namespace geoprior::embryo {
namespace {

std::string table_test_bytes(const std::string& name) {
  std::ifstream in(std::string(GEOPRIOR_SOURCE_DIR) + "/experiments/embryo/" + name,
                   std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The ontology that the table is a copy of.
struct TableOntology {
  Graph graph = read_graph(table_test_bytes("urinary.ttl"), RdfFormat::turtle, "urinary.ttl");
  Ontology ontology = make_ontology(graph, {"Ascent", 0}, "urinary.ttl");
  RuleProgram rules = parse_rules(table_test_bytes("development.rules"), "development.rules");

  [[nodiscard]] Development development(const std::optional<std::string>& disease) const {
    return {ontology,
            effects_of(saturate(rules, base_facts(graph, {disease, "Ascent"})), graph, ontology)};
  }
};

const TableOntology& table_ontology() {
  static const TableOntology one;
  return one;
}

/// Largest difference of two shapes, relative to the body.
double shape_gap(const Shape& a, const Shape& b, double body) {
  if (a.primitive != b.primitive || a.points.size() != b.points.size()) return 1;
  double gap = std::max({(a.center - b.center).norm(), (a.radii - b.radii).norm(),
                         std::abs(a.radius - b.radius), std::abs(a.end_radius - b.end_radius)});
  for (std::size_t i = 0; i < a.points.size(); ++i)
    gap = std::max(gap, (a.points[i] - b.points[i]).norm());
  return std::max({gap / body, (a.axes - b.axes).norm(), std::abs(a.egg - b.egg),
                   std::abs(a.branchings - b.branchings)});
}

void expect_same_state(const DayState& a, const DayState& b) {
  const double body = b.crown_rump_length;
  EXPECT_NEAR(a.crown_rump_length / body, 1, 1e-12);
  ASSERT_EQ(a.structures.size(), b.structures.size());
  for (std::size_t i = 0; i < a.structures.size(); ++i) {
    const int s = b.structures[i].structure;
    ASSERT_EQ(a.structures[i].structure, s);
    EXPECT_LT(shape_gap(a.structures[i].shape, b.structures[i].shape, body), 1e-12)
        << table_ontology().ontology.structures[s].name;
  }
  ASSERT_EQ(a.cuts.size(), b.cuts.size());
  for (std::size_t i = 0; i < a.cuts.size(); ++i) {
    EXPECT_EQ(a.cuts[i].whole, b.cuts[i].whole);
    EXPECT_LT(std::abs(a.cuts[i].tip - b.cuts[i].tip) / body, 1e-12);
    EXPECT_LT((a.cuts[i].point - b.cuts[i].point).norm() / body, 1e-12);
  }
  ASSERT_EQ(a.halves.size(), b.halves.size());
  for (std::size_t i = 0; i < a.halves.size(); ++i) {
    EXPECT_EQ(a.halves[i].product, b.halves[i].product);
    EXPECT_EQ(a.halves[i].sign, b.halves[i].sign);
    EXPECT_LT(shape_gap(a.halves[i].shape, b.halves[i].shape, body), 1e-12);
  }
  ASSERT_EQ(a.fused.size(), b.fused.size());
  for (std::size_t i = 0; i < a.fused.size(); ++i) {
    EXPECT_EQ(a.fused[i].members, b.fused[i].members);
    EXPECT_NEAR(a.fused[i].blend, b.fused[i].blend, 1e-15);
  }
  ASSERT_EQ(a.processes.size(), b.processes.size());
  for (std::size_t i = 0; i < a.processes.size(); ++i) {
    const std::string& name = table_ontology().ontology.processes[b.processes[i].process].name;
    EXPECT_EQ(a.processes[i].active, b.processes[i].active) << name;
    EXPECT_NEAR(a.processes[i].progress, b.processes[i].progress, 1e-12) << name;
    EXPECT_EQ(a.processes[i].met, b.processes[i].met) << name;
  }
}

class DirectTableDisease : public testing::TestWithParam<const char*> {};

TEST_P(DirectTableDisease, GivesTheStateThatTheOntologyAndItsRulesGive) {
  const std::string name = GetParam();
  const DirectTable table(table_disease(name).value_or(TableDisease::none));
  const Development development =
      table_ontology().development(name == "Healthy" ? std::nullopt : std::optional(name));
  ASSERT_EQ(table.first_day(), development.first_day());
  ASSERT_EQ(table.last_day(), development.last_day());
  for (double day = table.first_day(); day <= table.last_day(); day += 0.9)
    expect_same_state(table.at(day), development.at(day));
}

INSTANTIATE_TEST_SUITE_P(All, DirectTableDisease,
                         testing::Values("Healthy", "RenalAgenesisLeft", "HorseshoeKidney",
                                         "PersistentCloaca"),
                         [](const auto& one) { return std::string(one.param); });

TEST(DirectTable, NumbersStructuresAsTheOntologyDoes) {
  std::vector<std::string> names;
  for (const Structure& one : table_ontology().ontology.structures) names.push_back(one.name);
  EXPECT_EQ(DirectTable().structures(), names);
}

TEST(DirectTable, KnowsNoDiseaseThatNobodyWroteAFunctionFor) {
  EXPECT_FALSE(table_disease("DuplexUreterLeft"));
  EXPECT_FALSE(table_disease(""));
  EXPECT_EQ(table_disease("PersistentCloaca"), TableDisease::persistent_cloaca);
}

TEST(DirectTable, RefusesADayOutsideOfItsStages) {
  EXPECT_THROW((void)DirectTable().at(90), Error);
}

}  // namespace
}  // namespace geoprior::embryo
