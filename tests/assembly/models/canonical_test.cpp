// Canonical forms and walks, held against isomorphism by trial of all renumberings.

#include "models/assembly/isomorphism/canonical.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "models/assembly/isomorphism/traversal.h"
#include "tests/assembly/assemblies.h"

namespace geoprior::assembly {
namespace {

std::set<std::set<PortRef>> connection_sets(const Assembly& assembly) {
  std::set<std::set<PortRef>> out;
  for (const auto& [a, b] : assembly.connections) out.insert({a, b});
  return out;
}

/// With each part of a kind with symmetries turned by the one that `choice` has for it.
Assembly turned_parts(const Assembly& assembly, const std::vector<PartType>& types, int choice) {
  std::vector<const Symmetry*> turn(assembly.parts.size(), nullptr);
  for (std::size_t i = 0; i < turn.size(); ++i) {
    const auto& symmetries = types[assembly.parts[i].type].symmetries;
    const int count = static_cast<int>(symmetries.size()) + 1;
    if (choice % count > 0) turn[i] = &symmetries[choice % count - 1];
    choice /= count;
  }
  Assembly out = assembly;
  for (Connection& c : out.connections)
    for (PortRef* end : {&c.a, &c.b})
      if (turn[end->part]) end->port = turn[end->part]->ports[end->port];
  return out;
}

int turn_count(const Assembly& assembly, const std::vector<PartType>& types) {
  int out = 1;
  for (const PlacedPart& part : assembly.parts)
    out *= static_cast<int>(types[part.type].symmetries.size()) + 1;
  return out;
}

/// Whether some renumbering, with turns of parts, makes one of the other.
bool are_isomorphic(const Assembly& a, const Assembly& b, const std::vector<PartType>& types,
                    bool symmetries) {
  if (a.parts.size() != b.parts.size() || a.connections.size() != b.connections.size())
    return false;
  const auto wanted = connection_sets(b);
  std::vector<int> number(a.parts.size());
  std::iota(number.begin(), number.end(), 0);
  do {
    bool keeps_types = true;
    for (std::size_t i = 0; i < number.size(); ++i)
      keeps_types = keeps_types && a.parts[i].type == b.parts[number[i]].type;
    if (!keeps_types) continue;
    for (int turn = 0; turn < (symmetries ? turn_count(a, types) : 1); ++turn) {
      Assembly trial = turned_parts(a, types, turn);
      for (Connection& c : trial.connections) {
        c.a.part = number[c.a.part];
        c.b.part = number[c.b.part];
      }
      if (connection_sets(trial) == wanted) return true;
    }
  } while (std::next_permutation(number.begin(), number.end()));
  return false;
}

TEST(CanonicalForm, IsEqualExactlyForIsomorphicAssemblies) {
  std::vector<PartType> types = four_abstract_types();
  types.erase(types.begin());
  test::Dice dice(1, "canonical");
  std::vector<Assembly> graphs;
  for (int i = 0; i < 50; ++i) {
    graphs.push_back(random_graph(dice, types, 2, 4));
    if (i % 3 == 0) graphs.push_back(renumbered(graphs.back(), dice));
  }
  for (const bool symmetries : {false, true}) {
    int equal = 0;
    for (std::size_t i = 0; i < graphs.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const bool same = are_isomorphic(graphs[i], graphs[j], types, symmetries);
        if (same) ++equal;
        ASSERT_EQ(canonical_form(graphs[i], types, symmetries) ==
                      canonical_form(graphs[j], types, symmetries),
                  same)
            << i << " and " << j;
      }
    EXPECT_GT(equal, 15);
  }
}

TEST(CanonicalKey, StaysWhenPartsAreRenumberedAndTurnedBySymmetries) {
  const std::vector<PartType> types = four_abstract_types();
  test::Dice dice(2, "canonical");
  for (int i = 0; i < 60; ++i) {
    const Assembly graph = random_graph(dice, types, 5, 16);
    const Assembly other = renumbered(
        turned_parts(graph, types, dice.below(std::min(turn_count(graph, types), 1000))), dice);
    EXPECT_EQ(canonical_key(graph, types, true), canonical_key(other, types, true));
    EXPECT_EQ(canonical_key(graph, types, false),
              canonical_key(renumbered(graph, dice), types, false));
  }
}

TEST(CanonicalKey, DiffersByOnePort) {
  const std::vector<PartType> types{abstract_type("three", 3)};
  const Assembly pair = graph_of_pairs(2, {{0, 1}});
  Assembly other = pair;
  other.connections[0].b.port = 1;
  EXPECT_NE(canonical_key(pair, types, true), canonical_key(other, types, true));
}

TEST(CanonicalKey, KnowsAStraightTheOtherWayRoundOnlyWithoutSymmetries) {
  std::vector<PartType> types{abstract_type("x", 1), abstract_type("straight", 2),
                              abstract_type("y", 1)};
  types[1].symmetries.push_back({{1, 0}, Pose::Identity()});
  Assembly row;
  row.parts = {{0, Pose::Identity()}, {1, Pose::Identity()}, {2, Pose::Identity()}};
  row.connections = {{{0, 0}, {1, 0}}, {{1, 1}, {2, 0}}};
  Assembly other = row;
  other.connections = {{{0, 0}, {1, 1}}, {{1, 0}, {2, 0}}};
  EXPECT_EQ(canonical_key(row, types, true), canonical_key(other, types, true));
  EXPECT_NE(canonical_key(row, types, false), canonical_key(other, types, false));
}

TEST(CanonicalKey, OfSomePartsTellsTheirBoundaryInItsOrder) {
  // x - p - q - x, of which p and q are looked at: two parts that differ, with an end each.
  const std::vector<PartType> types{abstract_type("x", 1), abstract_type("p", 2),
                                    abstract_type("q", 2)};
  Assembly row;
  row.parts = {
      {0, Pose::Identity()}, {1, Pose::Identity()}, {2, Pose::Identity()}, {0, Pose::Identity()}};
  row.connections = {{{0, 0}, {1, 0}}, {{1, 1}, {2, 0}}, {{2, 1}, {3, 0}}};
  const PartSet middle = part_set(4, {1, 2});
  const auto key = [&](std::vector<int> boundary) {
    return canonical_key(row, types, middle, boundary, std::vector{0, 1}, true);
  };
  EXPECT_EQ(key({0, 2}), key({0, 2}));
  EXPECT_NE(key({0, 2}), key({2, 0}));
  // The same parts, with an end that is open in place of one that leads out.
  Assembly shorter = row;
  shorter.connections.pop_back();
  EXPECT_NE(canonical_key(row, types, middle, true), canonical_key(shorter, types, middle, true));
  // What is outside does not count.
  Assembly longer = row;
  longer.parts[3].type = 1;
  longer.connections[2].b.port = 1;
  EXPECT_EQ(canonical_key(row, types, middle, true), canonical_key(longer, types, middle, true));
}

TEST(CanonicalKey, OfSomePartsIsBlindToTheOrderWherePartsAreAlike) {
  const std::vector<PartType> types{abstract_type("x", 1), abstract_type("p", 2)};
  Assembly row;
  row.parts = {
      {0, Pose::Identity()}, {1, Pose::Identity()}, {1, Pose::Identity()}, {0, Pose::Identity()}};
  row.connections = {{{0, 0}, {1, 0}}, {{1, 1}, {2, 1}}, {{2, 0}, {3, 0}}};
  const PartSet middle = part_set(4, {1, 2});
  EXPECT_EQ(canonical_key(row, types, middle, std::vector{0, 2}, std::vector{0, 1}, true),
            canonical_key(row, types, middle, std::vector{2, 0}, std::vector{0, 1}, true));
}

TEST(TraversalKey, IsEqualExactlyForEqualCanonicalFormsAndAbsentForPieces) {
  const std::vector<PartType> types = four_abstract_types();
  for (const bool symmetries : {false, true}) {
    test::Dice dice(3, "traversal");
    std::map<CanonicalKey, CanonicalKey> canonical_of, walk_of;
    int whole = 0;
    for (int i = 0; i < 400; ++i) {
      const Assembly graph = random_graph(dice, types, 2, 8);
      const auto key = traversal_key(graph, types, symmetries);
      ASSERT_EQ(key.has_value(), components(graph).count == 1);
      if (!key) continue;
      ++whole;
      const CanonicalKey canonical = canonical_key(graph, types, symmetries);
      EXPECT_EQ(canonical_of.try_emplace(*key, canonical).first->second, canonical);
      EXPECT_EQ(walk_of.try_emplace(canonical, *key).first->second, *key);
    }
    EXPECT_GT(whole, 80);
    EXPECT_LT(static_cast<int>(walk_of.size()), whole) << "none came twice";
  }
}

TEST(TraversalKey, StaysWhenPartsAreRenumberedAndTurnedBySymmetries) {
  const std::vector<PartType> types = four_abstract_types();
  test::Dice dice(4, "traversal");
  for (int i = 0; i < 200; ++i) {
    const Assembly graph = random_graph(dice, types, 2, 16);
    const int turn = dice.below(std::min(turn_count(graph, types), 1000));
    EXPECT_EQ(traversal_key(graph, types, true),
              traversal_key(renumbered(turned_parts(graph, types, turn), dice), types, true));
    EXPECT_EQ(traversal_key(graph, types, false),
              traversal_key(renumbered(graph, dice), types, false));
    // Pieces have a key, too: that of their canonical form.
    EXPECT_EQ(isomorphism_key(graph, types, true),
              isomorphism_key(renumbered(turned_parts(graph, types, turn), dice), types, true));
  }
}

}  // namespace
}  // namespace geoprior::assembly
