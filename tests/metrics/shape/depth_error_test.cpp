#include "metrics/shape/depth_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

const Eigen::Vector3d kEye(0, 0, 3);

Eigen::MatrixX3d truth_points() { return shapes::sphere(0.5, {0, 0, 0}, 3).V; }

TEST(DepthError, AnOffsetIsForgivenWhenAskedTo) {
  const Eigen::MatrixX3d truth = truth_points();
  Eigen::MatrixX3d points = truth;
  points.col(2).array() += 0.2;
  EXPECT_NEAR(depth_error(points, truth, kEye, 1, DepthAlignment::none).rms, 0.2, 1e-14);
  const DepthError e = depth_error(points, truth, kEye, 1);
  EXPECT_LT(e.rms, 1e-15);
  EXPECT_NEAR(e.offset, -0.2, 1e-14);
  EXPECT_EQ(e.scale, 1);
  EXPECT_EQ(e.in_plane_rms, 0);
}

TEST(DepthError, OfAFlattenedSphereIsAShareOfItsSpread) {
  // On the octahedron's subdivision the mean of z^2 is R^2 / 3 by symmetry.
  const Eigen::MatrixX3d truth = truth_points();
  Eigen::MatrixX3d points = truth;
  points.col(2) *= 0.9;
  const DepthError e = depth_error(points, truth, kEye, 2);
  EXPECT_NEAR(e.rms, 0.1 * 0.5 / std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(e.share, e.rms / 2, 1e-15);
  EXPECT_NEAR(e.max, 0.05, 1e-14);
  const DepthError scaled = depth_error(points, truth, kEye, 2, DepthAlignment::offset_and_scale);
  EXPECT_NEAR(scaled.scale, 1 / 0.9, 1e-12);
  EXPECT_LT(scaled.rms, 1e-14);
}

TEST(DepthError, NearAndFarExchangedIsANegativeScale) {
  const Eigen::MatrixX3d truth = truth_points();
  Eigen::MatrixX3d points = truth;
  points.col(2) = 0.1 - truth.col(2).array();
  EXPECT_NEAR(depth_error(points, truth, kEye, 1).rms, 1 / std::sqrt(3.0), 1e-14);
  const DepthError e = depth_error(points, truth, kEye, 1, DepthAlignment::offset_and_scale);
  EXPECT_NEAR(e.scale, -1, 1e-12);
  EXPECT_NEAR(e.offset, 0.1, 1e-12);
  EXPECT_LT(e.rms, 1e-14);
}

TEST(DepthError, FollowsTheViewAndKeepsTheRestApart) {
  const Eigen::MatrixX3d truth = truth_points();
  Eigen::MatrixX3d points = truth;
  points.col(0).array() += 0.3;
  points.col(1).array() += 0.4;
  const DepthError above = depth_error(points, truth, kEye, 1, DepthAlignment::none);
  EXPECT_LT(above.rms, 1e-15);
  EXPECT_NEAR(above.in_plane_rms, 0.5, 1e-14);
  const DepthError along = depth_error(points, truth, {3, 4, 0}, 1, DepthAlignment::none);
  EXPECT_NEAR(along.rms, 0.5, 1e-14);
  EXPECT_LT(along.in_plane_rms, 1e-14);
}

TEST(DepthError, AFlatReconstructionCostsTheSpreadOfTheTruth) {
  const Eigen::MatrixX3d truth = truth_points();
  Eigen::MatrixX3d points = truth;
  points.col(2).setConstant(0.25);
  const DepthError e = depth_error(points, truth, kEye, 1, DepthAlignment::offset_and_scale);
  EXPECT_EQ(e.scale, 1);
  EXPECT_NEAR(e.rms, 0.5 / std::sqrt(3.0), 1e-14);
}

TEST(DepthError, RefusesWhatDoesNotMatch) {
  Eigen::MatrixX3d truth = truth_points();
  EXPECT_THROW(depth_error(truth.topRows(3), truth, kEye, 1), Error);
  EXPECT_THROW(depth_error(truth, truth, {0, 0, 0}, 1), Error);
  EXPECT_THROW(depth_error(truth, truth, kEye, 0), Error);
  EXPECT_THROW(depth_error(Eigen::MatrixX3d(0, 3), Eigen::MatrixX3d(0, 3), kEye, 1), Error);
  Eigen::MatrixX3d broken = truth;
  broken(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(depth_error(broken, truth, kEye, 1), Error);
}

}  // namespace
}  // namespace geoprior
