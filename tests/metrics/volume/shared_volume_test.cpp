#include "metrics/volume/shared_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

using std::numbers::pi;

Balls ball(double radius, const Eigen::Vector3d& centre) {
  return {centre.transpose(), Eigen::VectorXd::Constant(1, radius)};
}

double ball_volume(double radius) { return 4 * pi / 3 * std::pow(radius, 3); }

/// What two balls at the distance d share, when neither contains the other's centre plane:
/// pi (R + r - d)^2 (d^2 + 2 d (R + r) - 3 (R - r)^2) / (12 d).
double lens_of(double R, double r, double d) {
  return pi * std::pow(R + r - d, 2) * (d * d + 2 * d * (R + r) - 3 * std::pow(R - r, 2)) /
         (12 * d);
}

TEST(SharedVolume, OfTwoSpheresIsTheLens) {
  // The polyhedron of level 6 is 2e-4 smaller than its sphere; the rest is the grid's.
  const double R = 0.1, r = 0.07;
  const TriMesh sphere = shapes::sphere(R, {0.01, 0.02, -0.03}, 6);
  for (const double d : {0.05, 0.1, 0.15}) {
    for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1),
                                             Eigen::Vector3d(1.0 / 3, 2.0 / 3, 2.0 / 3)}) {
      const Eigen::Vector3d centre = Eigen::Vector3d(0.01, 0.02, -0.03) + d * direction;
      const SharedVolume v = shared_volume(ball(r, centre), sphere, R / 80);
      const double expected = lens_of(R, r, d);
      EXPECT_NEAR(v.first / ball_volume(r), 1, 1e-3) << d;
      EXPECT_NEAR(v.second / ball_volume(R), 1, 1e-3) << d;
      EXPECT_NEAR(v.both / expected, 1, 5e-3) << d;
      const double either = ball_volume(R) + ball_volume(r) - expected;
      EXPECT_NEAR(v.intersection_over_union().value(), expected / either, 1e-3) << d;
    }
  }
}

TEST(SharedVolume, ErrorFallsWithTheSpacing) {
  const double R = 0.1;
  const TriMesh sphere = shapes::sphere(R, Eigen::Vector3d::Zero(), 7);
  const auto error = [&](double spacing) {
    const SharedVolume v = shared_volume(ball(R, {0.08, 0.03, 0.02}), sphere, spacing);
    return std::abs(v.both / lens_of(R, R, Eigen::Vector3d(0.08, 0.03, 0.02).norm()) - 1);
  };
  EXPECT_LT(error(R / 10), 0.03);
  EXPECT_LT(error(R / 160), 1e-3);
}

TEST(SharedVolume, OverlappingBallsCountOnce) {
  const double r = 0.1, d = 0.12;
  Balls two;
  two.centres.resize(2, 3);
  two.centres << 0, 0, 0, d, 0, 0;
  two.radii = Eigen::Vector2d::Constant(r);
  const TriMesh box = shapes::box({-1, -1, -1}, {1, 1, 1});
  const SharedVolume v = shared_volume(two, box, r / 80);
  EXPECT_NEAR(v.first / (2 * ball_volume(r) - lens_of(r, r, d)), 1, 1e-3);
  EXPECT_NEAR(v.both, v.first, 1e-12);
  EXPECT_NEAR(v.second, 8, 1e-9);
  EXPECT_NEAR(v.intersection_over_union().value(), v.first / 8, 1e-12);
}

// A ball about the corner of a room: an eighth of it is inside, and lies in the surface.
TEST(SharedVolume, BallsCountInsideTheirRoom) {
  const double r = 0.1;
  const Balls corner{Eigen::MatrixX3d::Zero(1, 3), Eigen::VectorXd::Constant(1, r)};
  const TriMesh box = shapes::box({0, 0, 0}, {1, 1, 1});
  const Eigen::AlignedBox3d room(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  const SharedVolume v = shared_volume(corner, box, r / 80, room);
  EXPECT_NEAR(v.first / (ball_volume(r) / 8), 1, 0.01);  // half a column along two walls
  EXPECT_NEAR(v.both, v.first, 1e-12);
}

TEST(SharedVolume, OfVolumesApartIsNoneAndOfNothingIsAbsent) {
  const TriMesh box = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(shared_volume(ball(0.5, {3, 0, 0}), box, 0.1).intersection_over_union().value(), 0);
  EXPECT_EQ(shared_volume({}, box, 0.1).intersection_over_union().value(), 0);
  EXPECT_EQ(shared_volume(ball(0.5, {3, 0, 0}), {}, 0.1).intersection_over_union().value(), 0);
  EXPECT_FALSE(shared_volume({}, {}, 0.1).intersection_over_union().has_value());
}

TEST(SharedVolume, OfManyBallsIsTheSameWithOneThreadAndWithMany) {
  RandomStream random(3, "balls");
  Balls balls{Eigen::MatrixX3d(2000, 3), Eigen::VectorXd(2000)};
  for (double& x : balls.centres.reshaped()) x = random.uniform();
  for (double& r : balls.radii) r = 0.02 + 0.03 * random.uniform();
  const TriMesh sphere = shapes::sphere(0.4, {0.5, 0.5, 0.5}, 5);
  SharedVolume one;
  with_threads(1, [&] { one = shared_volume(balls, sphere, 0.01); });
  const SharedVolume many = shared_volume(balls, sphere, 0.01);
  EXPECT_EQ(one.both, many.both);
  EXPECT_EQ(one.first, many.first);
  EXPECT_GT(one.both, 0);
}

TEST(SharedVolume, RefusesWhatHasNoVolume) {
  const TriMesh box = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(shared_volume(ball(-1, {0, 0, 0}), box, 0.1), Error);
  EXPECT_THROW(shared_volume(ball(1, {0, 0, 0}), box, 0), Error);
  EXPECT_THROW(shared_volume(ball(1, {0, 0, 0}), box, 1e-9), Error);
  EXPECT_THROW(shared_volume({Eigen::MatrixX3d::Zero(2, 3), Eigen::VectorXd::Ones(1)}, box, 0.1),
               Error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(shared_volume(ball(1, {nan, 0, 0}), box, 0.1), Error);
}

}  // namespace
}  // namespace geoprior
