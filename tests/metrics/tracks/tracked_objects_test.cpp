#include "metrics/tracks/tracked_objects.h"

#include <gtest/gtest.h>

#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

// A box meshed alike on opposite sides has its centre of area in the middle.
TEST(TrackedObjects, AreBoxesByTheirIds) {
  const TriMesh both =
      shapes::together(shapes::box({0, 0, 0}, {2, 2, 2}), shapes::sphere(1, {7, 0, 0}, 3));
  Eigen::VectorXd track = Eigen::VectorXd::Constant(both.V.rows(), 3);
  Eigen::VectorXd kind = Eigen::VectorXd::Constant(both.V.rows(), 2);
  track.head(8).setConstant(9);
  kind.head(8).setConstant(1);
  const std::vector<TrackedObject> objects = tracked_objects(both, track, kind);
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].id, 3);
  EXPECT_EQ(objects[0].kind, 2);
  EXPECT_NEAR((objects[0].centre - Eigen::Vector3d(7, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(objects[1].id, 9);
  EXPECT_EQ(objects[1].kind, 1);
  EXPECT_EQ(objects[1].box_min, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(objects[1].box_max, Eigen::Vector3d(2, 2, 2));
}

TEST(TrackedObjects, LeaveVerticesOfNoTrackOut) {
  const TriMesh box = shapes::box({0, 0, 0}, {1, 1, 1});
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(box.V.rows());
  EXPECT_TRUE(tracked_objects(box, none, none).empty());
}

}  // namespace
}  // namespace geoprior
