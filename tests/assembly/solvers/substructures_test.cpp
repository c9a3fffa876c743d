// Connected sets of parts by the size of their boundary: counts that are known, and brute force.

#include "solvers/assembly/substructures.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "tests/assembly/assemblies.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::assembly {
namespace {

std::set<Substructure> distinct_substructures(const Assembly& assembly,
                                              const SubstructureLimits& limits) {
  const std::vector<Substructure> list = substructures(assembly, limits);
  std::set<Substructure> out(list.begin(), list.end());
  EXPECT_EQ(out.size(), list.size()) << "a substructure came twice";
  return out;
}

TEST(Substructures, OfAPathAreItsRunsOfParts) {
  // n (n + 1) / 2 runs, less the whole path.
  for (const int n : {2, 3, 8, 15})
    EXPECT_EQ(distinct_substructures(path_graph(n), {2, 1000, true}).size(), n * (n + 1) / 2 - 1);
}

TEST(Substructures, OfARingAreItsArcs) {
  // An arc begins at each part and has one to n - 1 parts.
  for (const int n : {2, 3, 8, 15})
    for (const bool unions : {false, true})
      EXPECT_EQ(distinct_substructures(ring_graph(n), {2, 1000, unions}).size(), n * (n - 1));
}

TEST(Substructures, OfAStarAreUnionsOfItsBonds) {
  // Leaves, and the centre with all but one to K of the five leaves: 5, and 5 + 10 + 10 for K = 3.
  const Assembly star = graph_of_pairs(6, {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}});
  EXPECT_EQ(distinct_substructures(star, {3, 1000, true}).size(), 30);
  EXPECT_EQ(distinct_substructures(star, {3, 1000, false}).size(), 10);
}

TEST(Substructures, WithoutUnionsAreTheSidesOfBonds) {
  const int n = 8;
  const auto sides = distinct_substructures(path_graph(n), {2, 1000, false});
  EXPECT_EQ(sides.size(), 2 * (n - 1));
  for (const Substructure& s : sides) EXPECT_EQ(s.boundary.size(), 1);
}

TEST(Substructures, HaveAtMostSoManyParts) {
  // Runs of at most two parts in a path of eight: 8 + 7.
  EXPECT_EQ(distinct_substructures(path_graph(8), {2, 2, true}).size(), 15);
}

TEST(Substructures, OfRandomGraphsAreThoseOfBruteForce) {
  test::Dice dice(7, "substructures");
  AssemblySet set;
  set.types = four_abstract_types();
  const Compatibility compatibility(set, true);
  int apart = 0, parallel = 0;
  std::size_t seen = 0;
  for (int i = 0; i < 150; ++i) {
    const Assembly graph = random_graph(dice, set.types, 5, 16);
    if (components(graph).count > 1) ++apart;
    std::set<std::pair<int, int>> pairs;
    for (const auto& [a, b] : graph.connections)
      if (!pairs.insert(std::minmax(a.part, b.part)).second) ++parallel;
    for (int boundary = 1; boundary <= 4; ++boundary) {
      MatchingOptions match;
      match.boundary = boundary;
      const auto oracle =
          make_brute_force(DonorSet{&set, &compatibility, {}}, {match})->substructures(graph);
      const std::set<Substructure> expected(oracle.begin(), oracle.end());
      ASSERT_EQ(distinct_substructures(graph, {boundary, 1000, true}), expected)
          << "graph " << i << ", K = " << boundary;
      seen += expected.size();
    }
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(parallel, 50);
  EXPECT_GT(seen, 10000);
}

TEST(Substructures, ComeInOneOrder) {
  test::Dice dice(8, "substructures");
  const Assembly graph = random_graph(dice, four_abstract_types(), 20, 20);
  EXPECT_EQ(substructures(graph, {4, 1000, true}), substructures(graph, {4, 1000, true}));
}

TEST(Substructures, RefuseABoundaryOfFive) {
  test::expect_error([] { (void)substructures(ring_graph(6), {5, 1000, true}); }, {"1 to 4"});
}

TEST(Substructures, AskForMemoryBeforePairsOfClassesAreMade) {
  // 435 connections, each its own class: pairs of them take 16 x 435^2 / 2 = 1.5 MB.
  const Assembly graph = complete_graph(30);
  ::setenv("GEOPRIOR_MEMORY_GB", "0.001", 1);
  EXPECT_NO_THROW((void)substructures(graph, {3, 1000, true}));
  test::expect_error(
      [&] {
        (void)substructures(graph, {4, 1000, true});
      },
      {"options.boundary", "435 classes of connections"});
  ::unsetenv("GEOPRIOR_MEMORY_GB");
  EXPECT_TRUE(substructures(graph, {4, 1000, true}).empty());
}

TEST(Substructures, OfABoundaryOfZeroAreRefused) {
  test::expect_error([] { (void)substructures(ring_graph(6), {0, 1000, true}); }, {"1 to 4"});
}

}  // namespace
}  // namespace geoprior::assembly
