#include "metrics/arrangement/changes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "tests/testbed/scratch_folder.h"

namespace geoprior {
namespace {

using Eigen::Vector3d;
using PointGroup = std::vector<Vector3d>;

const PointGroup kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(ArrangementChanges, ExtentIsALengthOrADiagonal) {
  EXPECT_EQ(extent_of({}), 0);
  EXPECT_EQ(extent_of(PointGroup{{1, 2, 3}}), 0);
  EXPECT_DOUBLE_EQ(extent_of(PointGroup{{1, 0, 0}, {1, 3, 4}}), 5);
  EXPECT_DOUBLE_EQ(extent_of(kSquare), std::sqrt(2));
}

TEST(ArrangementChanges, DistancesStayInARigidMotion) {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  PointGroup moved;
  for (const Vector3d& x : kSquare) moved.push_back(motion * x);
  EXPECT_NEAR(distance_change(kSquare, moved), 0, 1e-14);
}

TEST(ArrangementChanges, AStretchChangesTheSideMost) {
  PointGroup stretched;
  for (const Vector3d& x : kSquare) stretched.emplace_back(2 * x.x(), x.y(), x.z());
  // Sides grow by 1, diagonals by sqrt 5 - sqrt 2.
  EXPECT_EQ(distance_change(kSquare, stretched), 1);
  test::expect_error(
      [] {
        (void)distance_change(kSquare, PointGroup{{0, 0, 0}});
      },
      {"1 points after 4"});
}

/// What pops of one point that moves by `moved` while it is asked to move by `asked`.
double popped(const Vector3d& moved, const Vector3d& asked) {
  const PointGroup before{{5, 5, 5}}, after{before[0] + moved};
  const PointGroup at_rest{{1, 0, 0}}, of_map{at_rest[0] + asked};
  return unexplained_displacement(before, after, at_rest, of_map);
}

TEST(ArrangementChanges, StayingFollowingAndLaggingAreExplained) {
  const Vector3d asked(2, 0, 0);
  EXPECT_EQ(popped({0, 0, 0}, asked), 0);
  EXPECT_EQ(popped({2, 0, 0}, asked), 0);
  EXPECT_EQ(popped({0.5, 0, 0}, asked), 0);
}

TEST(ArrangementChanges, OvershootingGoingAsideAndGoingAlonePop) {
  const Vector3d asked(2, 0, 0);
  EXPECT_EQ(popped({3, 0, 0}, asked), 1);
  EXPECT_EQ(popped({-1, 0, 0}, asked), 1);
  EXPECT_EQ(popped({1, 0.5, 0}, asked), 0.5);
  EXPECT_EQ(popped({0, 3, 4}, {0, 0, 0}), 5);
}

}  // namespace
}  // namespace geoprior
