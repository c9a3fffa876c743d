// The tree of least deviation from a map: what is known of it without solving.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "baselines/grammar/optimum/tree.h"
#include "experiments/grammar/maps/gesture.h"
#include "models/grammar/objects/tree.h"
#include "solvers/grammar/engine/derivation.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;

TEST(GrammarOptimumTree, ARigidMotionIsReachedExactly) {
  const Hierarchy rest = make_tree({}, 1);
  const Eigen::Affine3d motion =
      Eigen::Translation3d(1, 0, 0) * Eigen::AngleAxisd(0.5, Vector3d::UnitX());
  const OptimumResult found = optimise_tree(rest, rest, AffineMap(motion));
  EXPECT_LT(found.deviation, 1e-7);
  EXPECT_LT((found.state.position(9) - motion * rest.position(9)).norm(), 1e-6);
}

TEST(GrammarOptimumTree, OneBranchThatIsDoubledIsHalfItsLengthTooShort) {
  Hierarchy rest({tree_type(), branch_type()});
  rest.add(0, -1, {});
  const double values[] = {1, 0.1, 1, 0, 1, 0.5};
  rest.add(1, 0, {}, values);
  const OptimumResult found =
      optimise_tree(rest, rest, AffineMap(Eigen::Affine3d(Eigen::Scaling(2.0))));
  // The tip is at 1.5 instead of 2: RMS 0.5 / sqrt 2 of the branch, 0 of the tree.
  EXPECT_NEAR(found.deviation, 0.5 / std::sqrt(2.0) / std::sqrt(2.0), 1e-12);
  EXPECT_LE(found.gradient, 1e-6);
}

TEST(GrammarOptimumTree, IsNoWorseThanTheGrammarAndAStationaryPoint) {
  TreeOptions options;
  options.branches = 80;
  options.levels = 2;
  const Hierarchy rest = make_tree(options, 1);
  const Eigen::AlignedBox3d box(Vector3d(-4, -4, 0), Vector3d(4, 4, 8));
  for (int number = 0; number < 6; ++number) {
    const auto map = map_of(random_gesture(5, number, box), 1);
    Hierarchy state = rest;
    Transaction transaction(state);
    derive(state, transaction, tree_rules(), {0, Delta::free(map)});
    const OptimumResult found = optimise_tree(rest, state, *map);
    EXPECT_LE(found.gradient, 1e-6);
    double sum = 0;
    for (int e = 1; e < rest.size(); ++e)
      for (const double end : {0.0, 1.0})
        sum +=
            0.5 * (attach_point(state, e, end) - map->at(attach_point(rest, e, end))).squaredNorm();
    const double grammar = std::sqrt(sum / rest.size());
    EXPECT_LE(found.deviation, grammar * (1 + 1e-6) + 1e-9);
    for (int e = 1; e < found.state.size(); ++e) {
      const double attach = found.state.parameter(e, BranchParameter::kAttach);
      const Vector3d on = attach_point(found.state, found.state.parent(e), attach);
      EXPECT_LT((found.state.position(e) - on).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace geoprior::grammar
