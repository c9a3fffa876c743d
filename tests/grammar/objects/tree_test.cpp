// The tree that the grammar deforms: what holds of it at rest.

#include "models/grammar/objects/tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/mesh.h"
#include "core/random.h"
#include "models/grammar/objects/crossing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

TEST(GrammarTree, BranchesHangOnTheAxesOfTheirParents) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Hierarchy tree = make_tree({}, seed);
    for (int e = 1; e < tree.size(); ++e) {
      const double attach = tree.parameter(e, BranchParameter::kAttach);
      EXPECT_LT((tree.position(e) - attach_point(tree, tree.parent(e), attach)).norm(), 1e-12);
    }
  }
}

TEST(GrammarTree, HasAsManyBranchesAsAsked) {
  TreeOptions options;
  for (const auto& [branches, levels] : {std::pair{150, 2}, {300, 3}, {2000, 4}}) {
    options.branches = branches;
    options.levels = levels;
    EXPECT_EQ(make_tree(options, 1).size() - 1, branches);
  }
}

TEST(GrammarTree, LengthsLieWithinBoundsOfTheMeanOfTheirLevel) {
  const Hierarchy tree = make_tree({}, 4);
  std::map<double, std::pair<double, int>> sum;
  for (int e = 1; e < tree.size(); ++e) {
    const double length = tree.parameter(e, BranchParameter::kLength);
    const double mean = tree.parameter(e, BranchParameter::kMean);
    EXPECT_GE(length, kShortestBranch * mean);
    EXPECT_LE(length, kLongestBranch * mean);
    auto& [total, count] = sum[mean];
    total += length;
    ++count;
  }
  EXPECT_EQ(sum.size(), 4u);
  for (const auto& [mean, level] : sum) EXPECT_NEAR(level.first / level.second, mean, 1e-9);
}

TEST(GrammarTree, NoTwoBranchesCrossByAllPairs) {
  const Hierarchy tree = make_tree({}, 5);
  for (int a = 1; a < tree.size(); ++a)
    for (int b = 1; b < a; ++b) {
      if (branches_meet(tree, a, b)) continue;
      EXPECT_GE(gap(branch_capsule(tree, a), branch_capsule(tree, b)), 0) << a << " and " << b;
    }
  EXPECT_EQ(crossing_branch(tree), -1);
}

TEST(GrammarTree, ABranchThatIsBentOntoAnotherIsFound) {
  Hierarchy tree = make_tree({}, 5);
  const int moved = tree.size() - 1;
  tree.set_position(moved, Vector3d(-0.05, 0, 0.4));  // across the trunk
  EXPECT_GE(crossing_branch(tree), 1);
}

TEST(GrammarTree, RadiiShrinkFromTheTrunkOn) {
  const TreeOptions options;
  const Hierarchy tree = make_tree(options, 6);
  EXPECT_DOUBLE_EQ(tree.parameter(1, BranchParameter::kRadius), options.trunk * options.height);
  for (int e = 2; e < tree.size(); ++e)
    EXPECT_LE(tree.parameter(e, BranchParameter::kRadius),
              tree.parameter(tree.parent(e), BranchParameter::kRadius));
}

TEST(GrammarTree, SameSeedSameTree) {
  const Hierarchy a = make_tree({}, 7), b = make_tree({}, 7), other = make_tree({}, 8);
  ASSERT_EQ(a.size(), b.size());
  for (int e = 0; e < a.size(); ++e) {
    EXPECT_EQ(a.position(e), b.position(e));
    EXPECT_EQ(a.turn(e).coeffs(), b.turn(e).coeffs());
  }
  EXPECT_NE(a.position(a.size() - 1), other.position(other.size() - 1));
}

TEST(GrammarTree, ABranchIsAClosedFrustumWithDomes) {
  const double p[] = {2, 0.1, 1, 0, 2, 0.5};
  const TriMesh mesh = branch_type().mesh(p);
  std::map<std::pair<int, int>, int> edges;
  for (int f = 0; f < mesh.triangle_count(); ++f)
    for (int k = 0; k < 3; ++k) ++edges[{mesh.F(f, k), mesh.F(f, (k + 1) % 3)}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  // Of the inscribed octagon: area 2 sqrt 2 r^2, frustum h / 3 (r^2 + r s + s^2).
  const double frustum = 2 * std::sqrt(2.0) * 2.0 / 3 * (0.01 + 0.005 + 0.0025);
  EXPECT_GT(signed_volume(mesh.V, mesh.F), frustum);
  EXPECT_LT(signed_volume(mesh.V, mesh.F), 1.1 * frustum);
}

TEST(GrammarTree, NamesTheOptionThatIsOutOfItsRange) {
  TreeOptions options;
  options.spread = 0;
  try {
    make_tree(options, 1);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("'spread'"), std::string::npos);
  }
}

TEST(GrammarCrossing, GapOfCapsulesInClosedForm) {
  const Capsule along_x{{-1, 0, 0}, {1, 0, 0}, 0.1};
  EXPECT_NEAR(gap(along_x, {{0, -1, 0.5}, {0, 1, 0.5}, 0.2}), 0.2, 1e-15);   // skew
  EXPECT_NEAR(gap(along_x, {{0, 0.4, 0}, {3, 0.4, 0}, 0.1}), 0.2, 1e-15);    // parallel
  EXPECT_NEAR(gap(along_x, {{4, 4, 0}, {6, 9, 0}, 1}), 5 - 1.1, 1e-15);      // end to end
  EXPECT_NEAR(gap(along_x, {{0.5, -1, 0}, {0.5, 1, 0}, 0.1}), -0.2, 1e-15);  // through
}

TEST(GrammarCrossing, GridFindsTheDeepestOfAllPairs) {
  RandomStream random(1, "capsules");
  const auto point = [&] { return Vector3d(random.uniform(), random.uniform(), random.uniform()); };
  std::vector<Capsule> all;
  CapsuleGrid grid(0.2, 400);
  for (int i = 0; i < 400; ++i) {
    const Vector3d a = 4 * point(), b = a + 0.5 * point();
    all.push_back({a, b, 0.05});
    grid.place(i, {point(), point(), 0.3});  // replaced at once
    grid.place(i, all.back());
  }
  for (int i = 0; i < 400; ++i) {
    double least = 0;
    for (int j = 0; j < 400; ++j)
      if (j != i) least = std::min(least, gap(all[i], all[j]));
    const auto found = grid.deepest(all[i], 0, [&](int other) { return other == i; });
    ASSERT_EQ(found.has_value(), least < 0);
    if (!found) continue;
    EXPECT_NEAR(found->depth, -least, 1e-12);
  }
}

}  // namespace
}  // namespace geoprior::grammar
