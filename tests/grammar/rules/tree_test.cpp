// What the rules of trees keep when a tree is deformed as a whole, and when one branch is edited.

#include "models/grammar/objects/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "experiments/grammar/maps/gesture.h"
#include "solvers/grammar/engine/derivation.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Branch = BranchParameter;

Eigen::AlignedBox3d tree_box(const Hierarchy& tree) {
  Eigen::AlignedBox3d box;
  for (int e = 1; e < tree.size(); ++e)
    box.extend(attach_point(tree, e, 1)).extend(tree.position(e));
  return box;
}

void expect_consistent_tree(const Hierarchy& tree) {
  EXPECT_EQ(crossing_branch(tree), -1);
  for (int e = 1; e < tree.size(); ++e) {
    if (!tree.present(e)) continue;
    const Vector3d on = attach_point(tree, tree.parent(e), tree.parameter(e, Branch::kAttach));
    EXPECT_LT((tree.position(e) - on).norm(), 1e-9) << tree.label(e);
    const double share = tree.parameter(e, Branch::kLength) / tree.parameter(e, Branch::kMean);
    EXPECT_GE(share, kShortestBranch - 1e-9) << tree.label(e);
    EXPECT_LE(share, kLongestBranch + 1e-9) << tree.label(e);
  }
}

bool same_branch_bits(const Hierarchy& a, const Hierarchy& b, int e) {
  const auto p = a.parameters(e), q = b.parameters(e);
  return a.position(e) == b.position(e) && a.turn(e).coeffs() == b.turn(e).coeffs() &&
         std::equal(p.begin(), p.end(), q.begin());
}

double squared_tree_deviation(const Hierarchy& rest, const Hierarchy& state,
                              const SpatialMap& map) {
  double sum = 0;
  for (int e = 1; e < rest.size(); ++e)
    for (const double end : {0.0, 1.0})
      sum += (attach_point(state, e, end) - map.at(attach_point(rest, e, end))).squaredNorm();
  return sum;
}

DerivationReport deform_tree(Hierarchy& tree, int element, const Delta& delta) {
  Transaction transaction(tree);
  return derive(tree, transaction, tree_rules(), {element, delta});
}

/// The last branch of the longest chain of parents.
int outermost_branch(const Hierarchy& tree) {
  int best = 1, most = 0;
  for (int e = 1; e < tree.size(); ++e) {
    int depth = 0;
    for (int above = e; above > 0; above = tree.parent(above)) ++depth;
    if (depth > most) {
      most = depth;
      best = e;
    }
  }
  return best;
}

/// Moves x by `shift` within a ball, the less the further from its middle.
class TreePullMap final : public SpatialMap {
 public:
  TreePullMap(const Vector3d& middle, double radius, const Vector3d& shift)
      : middle_(middle), radius_(radius), shift_(shift) {}
  [[nodiscard]] Vector3d at(const Vector3d& x) const override {
    const double s = (x - middle_).norm() / radius_;
    return s < 1 ? Vector3d(x + std::pow(1 - s * s, 2) * shift_) : x;
  }
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override {
    const Vector3d reach = Vector3d::Constant(radius_);
    return Eigen::AlignedBox3d(middle_ - reach, middle_ + reach);
  }

 private:
  Vector3d middle_;
  double radius_;
  Vector3d shift_;
};

TEST(GrammarTreeRules, GesturesLeaveBranchesAttachedWithinBoundsAndApart) {
  const Hierarchy rest = make_tree({}, 1);
  const Eigen::AlignedBox3d box = tree_box(rest);
  double with = 0, without = 0;
  for (int number = 0; number < 25; ++number) {
    const auto map = map_of(random_gesture(3, number, box), 1);
    Hierarchy tree = rest;
    deform_tree(tree, 0, Delta::free(map));
    expect_consistent_tree(tree);
    with += std::sqrt(squared_tree_deviation(rest, tree, *map));
    without += std::sqrt(squared_tree_deviation(rest, rest, *map));
  }
  EXPECT_LT(with, 0.5 * without);
}

TEST(GrammarTreeRules, WhatTheMapDoesNotReachStaysBitForBit) {
  const Hierarchy rest = make_tree({}, 2);
  const int pulled = outermost_branch(rest);
  const auto map =
      std::make_shared<TreePullMap>(attach_point(rest, pulled, 1), 1.2, Vector3d(0.3, 0.2, 0.2));
  Hierarchy tree = rest;
  const DerivationReport report = deform_tree(tree, 0, Delta::free(map));
  std::vector<char> reached(rest.size(), 0);
  int still = 0;
  for (int e = 1; e < rest.size(); ++e) {
    const Vector3d base = rest.position(e), tip = attach_point(rest, e, 1);
    reached[e] = reached[rest.parent(e)] || map->at(base) != base || map->at(tip) != tip;
    if (reached[e]) continue;
    ++still;
    EXPECT_TRUE(same_branch_bits(rest, tree, e)) << rest.label(e);
  }
  EXPECT_GT(still, 200);
  EXPECT_LT(report.rewrites, 120);
  EXPECT_FALSE(same_branch_bits(rest, tree, pulled));
}

TEST(GrammarTreeRules, TheIdentityAsksNoBranch) {
  const Hierarchy rest = make_tree({}, 2);
  Hierarchy tree = rest;
  const auto identity = std::make_shared<AffineMap>(Eigen::Affine3d::Identity());
  EXPECT_EQ(deform_tree(tree, 0, Delta::free(identity)).rewrites, 2);  // the tree, up and down
  for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(same_branch_bits(rest, tree, e));
}

TEST(GrammarTreeRules, ARigidMotionOfTheTreeIsFollowedExactly) {
  const Hierarchy rest = make_tree({}, 3);
  Hierarchy tree = rest;
  const Eigen::Affine3d motion =
      Eigen::Translation3d(1, 2, 0.5) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  deform_tree(tree, 0, Delta::rigid(motion));
  EXPECT_LT(squared_tree_deviation(rest, tree, AffineMap(motion)), 1e-20);
}

TEST(GrammarTreeRules, AStretchedTreeGrowsBranches) {
  const Hierarchy rest = make_tree({}, 3);
  Hierarchy tree = rest;
  const auto map = std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Scaling(2.0)));
  const DerivationReport report = deform_tree(tree, 0, Delta::free(map));
  EXPECT_GT(report.spawned, 50);
  expect_consistent_tree(tree);
  for (int e = rest.size(); e < tree.size(); ++e)
    EXPECT_TRUE(!tree.present(e) || tree.parameter(e, Branch::kAttach) == 1);
}

TEST(GrammarTreeRules, ATranslatedBranchKeepsItsEditAndItsParentCarriesIt) {
  const Hierarchy rest = make_tree({}, 1);
  const int branch = outermost_branch(rest);
  const Vector3d shift(0.3, -0.2, 0.1);
  Hierarchy tree = rest;
  const DerivationReport report = deform_tree(tree, branch, Delta::translate(shift));
  EXPECT_LT((tree.position(branch) - rest.position(branch) - shift).norm(), 1e-12);
  EXPECT_EQ(tree.turn(branch).coeffs(), rest.turn(branch).coeffs());
  EXPECT_EQ(tree.parameter(branch, Branch::kLength), rest.parameter(branch, Branch::kLength));
  EXPECT_FALSE(same_branch_bits(rest, tree, rest.parent(branch)));
  expect_consistent_tree(tree);
  // It ends below the branch that bounds the locality.
  for (int e = 1; e < rest.size(); ++e)
    EXPECT_TRUE(rest.is_below(e, report.turned_at) || same_branch_bits(rest, tree, e));
}

TEST(GrammarTreeRules, APullThatTheBranchesCannotReachMovesTheTree) {
  const Hierarchy rest = make_tree({}, 1);
  Hierarchy tree = rest;
  const Vector3d shift(0, 0, 2);
  EXPECT_EQ(deform_tree(tree, 1, Delta::translate(shift)).turned_at, 0);
  EXPECT_LT((tree.position(0) - shift).norm(), 1e-12);
  expect_consistent_tree(tree);
}

TEST(GrammarTreeRules, ALengthBeyondTheBoundIsSubdividedAndBeyondThatAnError) {
  const Hierarchy rest = make_tree({}, 1);
  const int branch = outermost_branch(rest);
  const double mean = rest.parameter(branch, Branch::kMean);
  Hierarchy tree = rest;
  EXPECT_EQ(deform_tree(tree, branch, Delta::set(Branch::kLength, 1.2 * mean)).spawned, 0);
  EXPECT_EQ(tree.parameter(branch, Branch::kLength), 1.2 * mean);
  tree = rest;
  deform_tree(tree, branch, Delta::set(Branch::kLength, 2.2 * mean));
  EXPECT_DOUBLE_EQ(tree.parameter(branch, Branch::kLength), kLongestBranch * mean);
  ASSERT_FALSE(tree.children(branch).empty());
  EXPECT_NEAR(tree.parameter(tree.children(branch)[0], Branch::kLength), 0.7 * mean, 1e-9);
  expect_consistent_tree(tree);
  tree = rest;
  for (const double share : {0.3, 4.0}) {
    EXPECT_THROW(deform_tree(tree, branch, Delta::set(Branch::kLength, share * mean)), Error);
    for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(same_branch_bits(rest, tree, e));
  }
}

TEST(GrammarTreeRules, ABranchIsGivenChildrenOrLosesTheThinnest) {
  const Hierarchy rest = make_tree({}, 1);
  int branch = 1;
  while (rest.children(branch).size() < 2) ++branch;
  Hierarchy tree = rest;
  EXPECT_EQ(deform_tree(tree, branch, Delta::children(3)).spawned, 3);
  expect_consistent_tree(tree);
  for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(same_branch_bits(rest, tree, e));
  for (int e = rest.size(); e < tree.size(); ++e) EXPECT_EQ(tree.parent(e), branch);

  Hierarchy fewer = rest;
  const int kept = rest.children(branch)[1];
  fewer.set_tag(kept, {1, Tag::Follow::rigid});
  EXPECT_GT(deform_tree(fewer, branch, Delta::children(-1000)).removed, 0);
  for (const int child : rest.children(branch)) EXPECT_EQ(fewer.present(child), child == kept);
}

TEST(GrammarTreeRules, TagsKeepParametersOrPlaces) {
  const Hierarchy rest = make_tree({}, 2);
  const int tagged = rest.parent(outermost_branch(rest));
  const auto map =
      std::make_shared<TreePullMap>(rest.position(tagged), 3.0, Vector3d(0.8, 0.3, 0.4));
  Hierarchy follows = rest, stops = rest;
  follows.set_tag(tagged, {1, Tag::Follow::rigid});
  stops.set_tag(tagged, {1, Tag::Follow::stop});
  deform_tree(follows, 0, Delta::free(map));
  deform_tree(stops, 0, Delta::free(map));
  expect_consistent_tree(follows);
  expect_consistent_tree(stops);
  int changed = 0;
  for (int e = 1; e < rest.size(); ++e) {
    changed += !same_branch_bits(rest, stops, e);
    if (!rest.is_below(e, tagged)) continue;
    const auto before = rest.parameters(e), after = follows.parameters(e);
    EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
    EXPECT_FALSE(same_branch_bits(rest, follows, e));
    EXPECT_TRUE(same_branch_bits(rest, stops, e));
  }
  EXPECT_GT(changed, 20);
}

TEST(GrammarTreeRules, AMapThatTakesABranchNowhereIsAnErrorAndUndone) {
  const Hierarchy rest = make_tree({}, 1);
  Hierarchy tree = rest;
  const auto map = std::make_shared<TreePullMap>(
      Vector3d(0, 0, 4), 2.0, Vector3d(0, 0, std::numeric_limits<double>::infinity()));
  EXPECT_THROW(deform_tree(tree, 0, Delta::free(map)), Error);
  for (int e = 0; e < rest.size(); ++e) EXPECT_TRUE(same_branch_bits(rest, tree, e));
}

}  // namespace
}  // namespace geoprior::grammar
