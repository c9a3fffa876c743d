// Cuts of graphs whose bonds are known, and of random ones by all sets of parts.

#include "solvers/assembly/cycle_space.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/disjoint_sets.h"
#include "tests/assembly/assemblies.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

using Bonds = std::set<std::vector<int>>;

Bonds bonds_of(const CycleSpace& space, int size) {
  Bonds out;
  int count = 0;
  space.for_each_bond(size, [&](std::span<const int> bond) {
    out.insert({bond.begin(), bond.end()});
    ++count;
  });
  EXPECT_EQ(static_cast<int>(out.size()), count) << "a bond came twice";
  EXPECT_EQ(space.bond_count(size), count);
  return out;
}

/// Whether the parts of one component that are in a set, or those that are not, hang together.
bool hangs_together(const Assembly& assembly, const std::vector<int>& parts,
                    const std::vector<char>& in, char side) {
  DisjointSets sets(static_cast<int>(in.size()));
  for (const auto& [a, b] : assembly.connections)
    if (in[a.part] == side && in[b.part] == side) sets.join(a.part, b.part);
  int first = -1;
  for (const int part : parts) {
    if (in[part] != side) continue;
    if (first < 0) first = part;
    if (sets.find(part) != sets.find(first)) return false;
  }
  return first >= 0;
}

/// Bonds of a size, by trying all ways to part each component in two.
Bonds bonds_by_parts(const Assembly& assembly, int size) {
  Bonds out;
  const Components pieces = components(assembly);
  for (int piece = 0; piece < pieces.count; ++piece) {
    std::vector<int> parts;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i)
      if (pieces.of_part[i] == piece) parts.push_back(static_cast<int>(i));
    const int n = static_cast<int>(parts.size());
    for (int mask = 1; mask < 1 << (n - 1); ++mask) {
      std::vector<char> in(assembly.parts.size(), 0);
      for (int k = 0; k + 1 < n; ++k) in[parts[k]] = static_cast<char>(mask >> k & 1);
      std::vector<int> cut;
      for (std::size_t c = 0; c < assembly.connections.size(); ++c)
        if (in[assembly.connections[c].a.part] != in[assembly.connections[c].b.part])
          cut.push_back(static_cast<int>(c));
      if (static_cast<int>(cut.size()) == size && hangs_together(assembly, parts, in, 0) &&
          hangs_together(assembly, parts, in, 1))
        out.insert(cut);
    }
  }
  return out;
}

TEST(CycleSpace, RingHasABondForEachPairOfItsConnections) {
  for (const int n : {2, 3, 7, 20}) {
    const CycleSpace space(ring_graph(n));
    EXPECT_TRUE(bonds_of(space, 1).empty());
    EXPECT_EQ(bonds_of(space, 2).size(), n * (n - 1) / 2);
    EXPECT_TRUE(bonds_of(space, 3).empty());
    EXPECT_TRUE(bonds_of(space, 4).empty());
  }
}

TEST(CycleSpace, PathIsAllBridges) {
  const CycleSpace space(path_graph(9));
  EXPECT_EQ(bonds_of(space, 1).size(), 8);
  for (int size = 2; size <= 4; ++size) EXPECT_TRUE(bonds_of(space, size).empty());
}

TEST(CycleSpace, CompleteGraphOfFourHasFourBondsOfThreeAndThreeOfFour) {
  // Connections 01 02 03 12 13 23: a bond of three frees a part, one of four leaves two pairs.
  const CycleSpace space(complete_graph(4));
  EXPECT_TRUE(bonds_of(space, 1).empty());
  EXPECT_TRUE(bonds_of(space, 2).empty());
  EXPECT_EQ(bonds_of(space, 3), (Bonds{{0, 1, 2}, {0, 3, 4}, {1, 3, 5}, {2, 4, 5}}));
  EXPECT_EQ(bonds_of(space, 4), (Bonds{{1, 2, 3, 4}, {0, 2, 3, 5}, {0, 1, 4, 5}}));
}

TEST(CycleSpace, TwoPartsJoinedTwiceAreABondOfTwo) {
  const CycleSpace space(graph_of_pairs(2, {{0, 1}, {1, 0}}));
  EXPECT_EQ(bonds_of(space, 2), (Bonds{{0, 1}}));
  EXPECT_TRUE(space.bridges().empty());
}

TEST(CycleSpace, ConnectionOfAPartWithItselfIsInNoBond) {
  const CycleSpace space(graph_of_pairs(3, {{0, 1}, {1, 1}, {1, 2}}));
  EXPECT_EQ(bonds_of(space, 1), (Bonds{{0}, {2}}));
  for (int size = 2; size <= 4; ++size) EXPECT_TRUE(bonds_of(space, size).empty());
}

TEST(CycleSpace, BondsOfRandomGraphsAreThoseOfAllTheirBipartitions) {
  test::Dice dice(1, "cycle space");
  const std::vector<PartType> types = four_abstract_types();
  std::size_t several = 0;
  for (int i = 0; i < 60; ++i) {
    const Assembly graph = random_graph(dice, types, 2, 9);
    if (components(graph).count > 1) ++several;
    const CycleSpace space(graph);
    for (int size = 1; size <= 4; ++size)
      ASSERT_EQ(bonds_of(space, size), bonds_by_parts(graph, size)) << "graph " << i;
  }
  EXPECT_GT(several, 10);
}

TEST(CycleSpace, SidesOfABondAreTheComponentWithNothingElseBetween) {
  test::Dice dice(2, "cycle space");
  const std::vector<PartType> types = four_abstract_types();
  for (int i = 0; i < 20; ++i) {
    const Assembly graph = random_graph(dice, types, 4, 20);
    const CycleSpace space(graph);
    for (int size = 1; size <= 4; ++size)
      space.for_each_bond(size, [&](std::span<const int> bond) {
        const PartSet side = space.far_side(bond), rest = space.rest_of_component(side);
        EXPECT_FALSE(side.empty());
        EXPECT_FALSE(rest.empty());
        EXPECT_FALSE(side.meets(rest));
        std::vector<int> between;
        for (std::size_t c = 0; c < graph.connections.size(); ++c) {
          const auto& [a, b] = graph.connections[c];
          if (side.has(a.part) != side.has(b.part)) between.push_back(static_cast<int>(c));
        }
        EXPECT_EQ(between, std::vector<int>(bond.begin(), bond.end()));
      });
  }
}

TEST(CycleSpace, RefusesBondsOfFive) {
  const CycleSpace space(ring_graph(4));
  test::expect_error([&] { space.for_each_bond(5, [](std::span<const int>) {}); },
                     {"5 connections", "1 to 4"});
}

}  // namespace
}  // namespace geoprior::assembly
