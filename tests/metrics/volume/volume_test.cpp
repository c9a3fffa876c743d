#include "metrics/volume/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

using std::numbers::pi;

TEST(Volume, BoxIsExactFarFromTheOrigin) {
  const TriMesh box = shapes::box({100, 200, 300}, {101, 202, 303});
  // Coordinates of 300 carry round-off of 300 * 2^-53; 1e-12 is some ten of those over faces of 6.
  EXPECT_NEAR(signed_volume(box.V, box.F), 6, 1e-11);
  EXPECT_NEAR(signed_volume(box.V, shapes::inverted(box).F), -6, 1e-11);
}

TEST(Volume, InscribedSphereConvergesWithOrderTwo) {
  const double exact = 4 * pi / 3 * 0.125;
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const TriMesh s = shapes::sphere(0.5, {0.3, -0.2, 1}, 4 + i);
    error[i] = exact - signed_volume(s.V, s.F);
  }
  // A polyhedron inscribed with edges h misses O(h^2) of a smooth body.
  EXPECT_GT(error[1], 0);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.05);
}

TEST(Volume, TorusConvergesToPappus) {
  const double exact = 2 * pi * pi * 0.8 * 0.09;
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const TriMesh t = shapes::torus(0.8, 0.3, 64 << i, 32 << i);
    error[i] = std::abs(exact - signed_volume(t.V, t.F));
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.05);
}

/// A region of given triangles, its border traced by hand.
JointRegion open_box_region() {
  JointRegion region;
  region.triangles = {0, 1, 4, 5, 6, 7, 8, 9, 10, 11};  // all but the top (2, 3)
  region.border_loops = {{4, 6, 7, 5}};
  return region;
}

TEST(RegionVolume, FanClosesABoxWithoutItsTop) {
  const TriMesh box = shapes::box({0, 0, 0}, {1, 2, 3});
  // The fan lies in the plane of the missing face, so the volume is that of the box.
  EXPECT_NEAR(region_volume(box.V, box.F, open_box_region()), 6, 1e-14);
}

TEST(RegionVolume, CylinderRegionIsAStackOfAntiprisms) {
  CylinderOptions options;
  const RiggedMesh rig = two_bone_cylinder(options);
  const JointRegion region = make_joint_region(rig, "joint", {1}, {{0, 1, 0}});
  double low = 0;
  double high = 0;
  for (const int v : region_vertices(region, rig.mesh.F)) {
    low = std::min(low, rig.mesh.V(v, 0));
    high = std::max(high, rig.mesh.V(v, 0));
  }
  // Neighbouring rings are turned by half a segment: antiprisms, by the prismatoid formula with a
  // regular polygon of n corners below and above and one of 2n corners half way.
  const int n = options.segments;
  const double r2 = options.radius * options.radius;
  const double end = 0.5 * n * std::sin(2 * pi / n) * r2;
  const double middle = n * std::sin(pi / n) * r2 * std::pow(std::cos(pi / (2 * n)), 2);
  const double exact = (2 * end + 4 * middle) / 6 * (high - low);
  EXPECT_NEAR(region_volume(rig.mesh.V, rig.mesh.F, region) / exact, 1, 1e-13);
}

TEST(RegionVolume, DoesNotChangeUnderARigidMotion) {
  const RiggedMesh rig = capsule_finger();
  const JointRegion region =
      make_joint_region(rig, "finger", {1, 2, 3}, {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}});
  const Eigen::Affine3d T = Eigen::Translation3d(1, -2, 0.5) *
                            Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized());
  const Eigen::MatrixX3d moved =
      ((T.linear() * rig.mesh.V.transpose()).colwise() + T.translation()).transpose();
  const double rest = region_volume(rig.mesh.V, rig.mesh.F, region);
  EXPECT_GT(rest, 0);
  // Round-off of coordinates of size 2 m over a surface of some cm: 1e-10 relative is generous.
  EXPECT_NEAR(*relative_change(rest, region_volume(moved, rig.mesh.F, region)), 0, 1e-10);
}

TEST(VolumeCentroid, OfABoxAndOfTwoSpheres) {
  const Eigen::Vector3d c = volume_centroid(shapes::box({1, 2, 3}, {2, 4, 7}));
  EXPECT_LT((c - Eigen::Vector3d(1.5, 3, 5)).norm(), 1e-14);
  // Equal spheres: half way between, whatever their tessellation's volume is.
  const TriMesh two =
      shapes::together(shapes::sphere(0.3, {0, 0, 0}, 3), shapes::sphere(0.3, {0, 0, 2}, 3));
  EXPECT_LT((volume_centroid(two) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-14);
  EXPECT_THROW(volume_centroid(TriMesh{}), Error);
}

TEST(RelativeChange, IsRelativeToTheFirstAndAbsentWhereThatIsZero) {
  EXPECT_DOUBLE_EQ(*relative_change(2, 1.5), -0.25);
  EXPECT_DOUBLE_EQ(*relative_change(0, 0), 0);
  EXPECT_FALSE(relative_change(0, 1));
}

}  // namespace
}  // namespace geoprior
