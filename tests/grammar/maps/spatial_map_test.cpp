// Maps of space: composition, inverse, rotation, reach.

#include "models/grammar/maps/spatial_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/grammar/maps/gesture.h"
#include "models/grammar/maps/strokes.h"
#include "tests/grammar/maps/sampled_map.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using geoprior::test::expect_error;

/// z goes to z^2 - 1, which folds space at z = 0 and reaches nothing below -1.
class CreasedMap final : public SpatialMap {
 public:
  [[nodiscard]] Vector3d at(const Vector3d& x) const override {
    return {x.x(), x.y(), x.z() * x.z() - 1};
  }
};

std::shared_ptr<const SpatialMap> grabbing_map(const Vector3d& from, const Vector3d& to, double r) {
  Gesture gesture;
  gesture.strokes.push_back({.path = {from, to}, .radius = r});
  return map_of(gesture, 1);
}

TEST(GrammarMaps, RotationOfIsTheOrthogonalFactor) {
  geoprior::test::Dice dice(1, "rotations");
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond turn = dice.rotation();
    const Matrix3d frame = dice.rotation().toRotationMatrix();
    const Vector3d stretch = (dice.vector(2)).array().exp();
    const Matrix3d symmetric = frame * stretch.asDiagonal() * frame.transpose();
    const Eigen::Quaterniond found = rotation_of(turn.toRotationMatrix() * symmetric);
    EXPECT_LT(found.angularDistance(turn), 1e-7);
    EXPECT_LT((found.toRotationMatrix() - turn.toRotationMatrix()).norm(), 1e-13);
  }
}

TEST(GrammarMaps, RotationOfTheIdentityIsTheIdentityBitForBit) {
  EXPECT_EQ(rotation_of(Matrix3d::Identity()).coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(GrammarMaps, RotationOfWhatIsInsideOutIsRefused) {
  expect_error([] { rotation_of(Vector3d(1, 1, -1).asDiagonal()); }, {"determinant"});
  expect_error([] { rotation_of(Matrix3d::Zero()); }, {"determinant"});
}

TEST(GrammarMaps, DefaultJacobianOfAffineMapIsItsMatrix) {
  class Plain final : public SpatialMap {
   public:
    [[nodiscard]] Vector3d at(const Vector3d& x) const override {
      return {2 * x.x() + x.y(), x.y() - 3 * x.z(), x.z()};
    }
  };
  Matrix3d expected;
  expected << 2, 1, 0, 0, 1, -3, 0, 0, 1;
  EXPECT_LT((Plain().with_jacobian({1, 2, 3}).jacobian - expected).norm(), 1e-9);
}

TEST(GrammarMaps, ComposedMapFollowsTheChainRule) {
  const auto first = grabbing_map({0, 0, 4}, {1, 0, 4.5}, 4);
  const auto second = grabbing_map({1, 1, 3}, {0, 2, 3}, 3);
  const ComposedMap both(first, second);
  EXPECT_LT(samples::jacobian_error(both, samples::points_in(samples::kSampledBox, 300, 2)), 1e-8);
  const AlignedBox3d support = both.support().value();
  EXPECT_TRUE(support.contains(first->support().value()));
  EXPECT_TRUE(support.contains(second->support().value()));
}

TEST(GrammarMaps, ComposedWithAMapOfAllSpaceMovesAllSpace) {
  const auto everywhere =
      std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Translation3d(0, 0, 1)));
  EXPECT_FALSE(ComposedMap(grabbing_map({0, 0, 0}, {1, 0, 0}, 2), everywhere).support());
}

TEST(GrammarMaps, ReachesWhatItsSupportMeets) {
  const auto map = grabbing_map({0, 0, 0}, {0.1, 0, 0}, 1);
  EXPECT_TRUE(reaches(*map, {Vector3d(0.5, 0, 0), Vector3d(3, 1, 1)}));
  EXPECT_FALSE(reaches(*map, {Vector3d(1.5, 0, 0), Vector3d(3, 1, 1)}));
  EXPECT_FALSE(reaches(*map_of({}, 1), samples::kSampledBox));
  EXPECT_TRUE(reaches(AffineMap(Eigen::Affine3d::Identity()), samples::kSampledBox));
}

TEST(GrammarMaps, InverseLeadsBackToRoundOff) {
  for (int i = 0; i < 40; ++i) {
    const std::shared_ptr<const SpatialMap> map =
        map_of(random_gesture(3, i, samples::kSampledBox), 1);
    const InverseMap inverse(map);
    for (const Vector3d& x : samples::points_in(samples::kSampledBox, 60, i)) {
      EXPECT_LT((inverse.at(map->at(x)) - x).norm(), 1e-12) << "gesture " << i;
      EXPECT_LT((map->at(inverse.at(x)) - x).norm(), 1e-12) << "gesture " << i;
    }
  }
}

TEST(GrammarMaps, InverseJacobianIsTheInverseMatrix) {
  const auto map = grabbing_map({0, 0, 4}, {2, 0, 4.5}, 5);
  const InverseMap inverse(map);
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 100, 5)) {
    const MappedPoint there = map->with_jacobian(x);
    const Matrix3d both = inverse.with_jacobian(there.position).jacobian * there.jacobian;
    EXPECT_LT((both - Matrix3d::Identity()).norm(), 1e-11);
  }
}

TEST(GrammarMaps, InverseIsTheIdentityBitForBitOutsideTheSupport) {
  const InverseMap inverse(grabbing_map({0, 0, 4}, {2, 0, 4.5}, 3));
  for (const Vector3d& x : samples::points_in(samples::kSampledBox, 300, 6)) {
    if (inverse.support()->contains(x)) continue;
    EXPECT_EQ(inverse.at(x), x);
    EXPECT_EQ(inverse.with_jacobian(x).jacobian, Matrix3d::Identity());
  }
}

TEST(GrammarMaps, InverseOfAFoldIsRefused) {
  const InverseMap inverse(std::make_shared<CreasedMap>());
  expect_error([&] { (void)inverse.at({0, 0, -2}); }, {"point (0, 0, -2)"});
}

}  // namespace
}  // namespace geoprior::grammar
