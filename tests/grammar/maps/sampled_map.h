#pragma once

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "models/grammar/maps/spatial_map.h"
#include "tests/support/dice.h"

namespace geoprior::grammar::samples {

inline const Eigen::AlignedBox3d kSampledBox{Eigen::Vector3d(-3, -3, 0), Eigen::Vector3d(3, 3, 8)};

inline std::vector<Eigen::Vector3d> points_in(const Eigen::AlignedBox3d& box, int count, int seed) {
  geoprior::test::Dice dice(seed, "points");
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < count; ++i)
    out.push_back(box.center() + dice.vector(0.5).cwiseProduct(box.sizes()));
  return out;
}

/// Largest difference of the Jacobian from central differences of `at`, whose own error is about
/// 1e-8 with this step.
inline double jacobian_error(const SpatialMap& map, const std::vector<Eigen::Vector3d>& points) {
  constexpr double kStep = 1e-5;
  double worst = 0;
  for (const Eigen::Vector3d& x : points) {
    const MappedPoint m = map.with_jacobian(x);
    EXPECT_EQ(m.position, map.at(x));
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d h = kStep * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d slope = (map.at(x + h) - map.at(x - h)) / (2 * kStep);
      worst = std::max(worst, (slope - m.jacobian.col(axis)).cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

inline double least_determinant(const SpatialMap& map, const std::vector<Eigen::Vector3d>& points) {
  double least = 1;
  for (const Eigen::Vector3d& x : points)
    least = std::min(least, map.with_jacobian(x).jacobian.determinant());
  return least;
}

}  // namespace geoprior::grammar::samples
