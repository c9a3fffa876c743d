#include "metrics/shape/silhouette_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

const Eigen::Matrix3d kIdentity = Eigen::Matrix3d::Identity();

PlanarLoop unit_circle() {
  PlanarLoop loop;
  for (int i = 0; i < 720; ++i) {
    const double t = std::numbers::pi * i / 360;
    loop.emplace_back(std::cos(t), std::sin(t));
  }
  return loop;
}

// The outline of a ball is a great circle: planar, at the depth of its centre. Contour edges of the
// mesh zigzag about it by less than an edge, 0.07 here.
TEST(SilhouetteDepth, OfABallIsPlanar) {
  const TriMesh ball = shapes::sphere(1, {0, 0, 5}, 4);
  const SilhouetteDepth depth = silhouette_depth(ball, kIdentity, unit_circle());
  for (const auto& d : depth.depth) {
    ASSERT_TRUE(d.has_value());
    EXPECT_NEAR(*d, 5, 0.07);
  }
  EXPECT_LT(depth.range, 0.07);
  EXPECT_LT(depth.jump, 0.07);
  EXPECT_LT(depth.plane_rms, 0.02);
}

// Side by side in the view, their front faces 3 apart of 4 in depth.
TEST(SilhouetteDepth, JumpsFromOneBoxToTheOther) {
  const TriMesh boxes =
      shapes::together(shapes::box({-1, 0, 0}, {0, 1, 1}), shapes::box({0, 0, 3}, {1, 1, 4}));
  const PlanarLoop outline{{-1, 0}, {1, 0}, {1, 1}, {-1, 1}};
  const SilhouetteDepth depth = silhouette_depth(boxes, kIdentity, outline);
  EXPECT_NEAR(depth.jump, 0.75, 1e-12);
  EXPECT_NEAR(depth.range, 0.75, 1e-12);
  EXPECT_GT(depth.plane_rms, 0.1);
}

TEST(SilhouetteDepth, RefusesADrawingThatIsElsewhere) {
  PlanarLoop away = unit_circle();
  for (Eigen::Vector2d& p : away) p.x() += 10;
  EXPECT_THROW(silhouette_depth(shapes::sphere(1, {0, 0, 0}, 2), kIdentity, away), Error);
  EXPECT_THROW(silhouette_depth(shapes::sphere(1, {0, 0, 0}, 2), kIdentity, {{0, 0}, {1, 0}}),
               Error);
}

}  // namespace
}  // namespace geoprior
