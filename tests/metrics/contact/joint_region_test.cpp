#include "metrics/contact/joint_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

const Eigen::Vector3d kBendingAxis(0, 1, 0);

/// Euler characteristic of the region's triangles: 2 for a closed sphere, less one a border loop.
int euler_characteristic(const JointRegion& region, const Eigen::MatrixX3i& F) {
  std::set<std::pair<int, int>> edges;
  for (const int t : region.triangles) {
    for (int k = 0; k < 3; ++k) edges.insert(std::minmax(F(t, k), F(t, (k + 1) % 3)));
  }
  return static_cast<int>(region_vertices(region, F).size()) - static_cast<int>(edges.size()) +
         static_cast<int>(region.triangles.size());
}

TEST(JointRegion, OfACylinderIsATubeOfTwoRadiiEachWay) {
  CylinderOptions options;
  const RiggedMesh rig = two_bone_cylinder(options);
  const JointRegion region = make_joint_region(rig, "joint", {1}, {kBendingAxis});
  const JointRegion::Hinge& hinge = region.hinges.front();
  EXPECT_NEAR(hinge.radius, options.radius, 1e-12);
  EXPECT_TRUE(hinge.distal.isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(hinge.proximal.isApprox(-Eigen::Vector3d::UnitX()));
  EXPECT_EQ(hinge.proximal_joint, 0);
  EXPECT_EQ(region.border_loops.size(), 2u);
  EXPECT_EQ(euler_characteristic(region, rig.mesh.F), 0);
  const double ring = options.half_length / options.rings_per_half;
  for (const std::vector<int>& loop : region.border_loops) {
    EXPECT_EQ(loop.size(), static_cast<std::size_t>(options.segments));
    for (const int v : loop) {
      // The last ring within two radii, or the first beyond it.
      EXPECT_NEAR(std::abs(rig.mesh.V(v, 0)), 2 * options.radius, ring + 1e-12);
    }
  }
  EXPECT_EQ(border_rigidity(rig, region), 1);
}

TEST(JointRegion, LoopsRunAlongBoundaryEdgesOfTheRegion) {
  const RiggedMesh rig = two_bone_cylinder();
  const JointRegion region = make_joint_region(rig, "joint", {1}, {kBendingAxis}, 1.5);
  std::multiset<std::pair<int, int>> directed;
  for (const int t : region.triangles) {
    for (int k = 0; k < 3; ++k) directed.emplace(rig.mesh.F(t, k), rig.mesh.F(t, (k + 1) % 3));
  }
  std::size_t boundary = 0;
  for (const auto& [a, b] : directed) boundary += directed.count({b, a}) == 0 ? 1 : 0;
  std::size_t traced = 0;
  for (const std::vector<int>& loop : region.border_loops) {
    for (std::size_t i = 0; i < loop.size(); ++i, ++traced) {
      const std::pair<int, int> edge{loop[i], loop[(i + 1) % loop.size()]};
      EXPECT_EQ(directed.count(edge), 1u);
      EXPECT_EQ(directed.count({edge.second, edge.first}), 0u);
    }
  }
  EXPECT_EQ(traced, boundary);
}

TEST(JointRegion, OfAWholeFingerIsOneTube) {
  const RiggedMesh rig = capsule_finger();
  const JointRegion region =
      make_joint_region(rig, "finger", {1, 2, 3}, {kBendingAxis, kBendingAxis, kBendingAxis});
  EXPECT_EQ(region.hinges.size(), 3u);
  // Closed at the tip when two radii of the last joint reach it: one or two border loops.
  EXPECT_EQ(euler_characteristic(region, rig.mesh.F),
            2 - static_cast<int>(region.border_loops.size()));
  double low = 0;
  double high = 0;
  for (const int v : region_vertices(region, rig.mesh.F)) {
    low = std::min(low, rig.mesh.V(v, 0));
    high = std::max(high, rig.mesh.V(v, 0));
  }
  EXPECT_LT(low, -0.015);
  EXPECT_GT(high, 0.065 + 0.014);
  // Sections of neighbouring joints do not reach past the middle of the bone between them.
  EXPECT_LE(region.hinges[0].distal_reach + region.hinges[1].proximal_reach, 0.04 + 1e-12);
  EXPECT_GE(border_rigidity(rig, region), 0.999);
}

/// A palm (one flat box of skin) is replaced by two parallel cylinders that share the root: the
/// region of one must not reach the other, however close.
TEST(JointRegion, KeepsOffTheNeighbouringLimb) {
  CylinderOptions options;
  const RiggedMesh one = two_bone_cylinder(options);
  RiggedMesh two = one;
  TriMesh other = one.mesh;
  other.V.col(1).array() += 2.02 * options.radius;
  two.mesh = shapes::together(one.mesh, other);
  const int n = one.mesh.vertex_count();
  two.skeleton.joints.push_back(one.skeleton.joints[1]);
  two.skeleton.joints[2].name = "neighbour";
  two.skeleton.joints[2].head.y() += 2.02 * options.radius;
  if (two.skeleton.joints[2].tail) two.skeleton.joints[2].tail->y() += 2.02 * options.radius;
  two.weights.resize(2 * n, 3);
  for (int v = 0; v < n; ++v) {
    for (int j = 0; j < 2; ++j) {
      const double w = one.weights.coeff(v, j);
      if (w == 0) continue;
      two.weights.coeffRef(v, j) = w;
      two.weights.coeffRef(n + v, j == 0 ? 0 : 2) = w;
    }
  }
  const JointRegion alone = make_joint_region(one, "joint", {1}, {kBendingAxis});
  const JointRegion beside = make_joint_region(two, "joint", {1}, {kBendingAxis});
  EXPECT_EQ(alone.triangles, beside.triangles);
  EXPECT_EQ(alone.border_loops, beside.border_loops);
}

TEST(JointRegion, GrowsWithTheExtent) {
  const RiggedMesh rig = two_bone_cylinder();
  const auto count = [&](double extent) {
    return make_joint_region(rig, "joint", {1}, {kBendingAxis}, extent).triangles.size();
  };
  EXPECT_LT(count(1), count(2));
  EXPECT_LT(count(2), count(3));
}

TEST(JointRegion, RigidWeightsStillGiveTheRadius) {
  RiggedMesh rig = two_bone_cylinder();
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const bool upper = rig.mesh.V(v, 0) >= 0;
    rig.weights.coeffRef(v, 0) = upper ? 0 : 1;
    rig.weights.coeffRef(v, 1) = upper ? 1 : 0;
  }
  const JointRegion region = make_joint_region(rig, "joint", {1}, {kBendingAxis});
  EXPECT_NEAR(region.hinges.front().radius, 0.1, 1e-12);
}

TEST(JointRegion, ChainCoordinateIsSignedAlongTheBones) {
  JointRegion::Hinge hinge;
  hinge.head = {1, 0, 0};
  hinge.distal = {0, 1, 0};
  hinge.proximal = {-1, 0, 0};
  EXPECT_DOUBLE_EQ(chain_coordinate(hinge, {1.2, 3, 0}), 3);
  EXPECT_DOUBLE_EQ(chain_coordinate(hinge, {-1, -0.5, 0}), -2);
}

TEST(JointRegion, NamesWhatIsWrong) {
  const RiggedMesh rig = two_bone_cylinder();
  EXPECT_THROW(make_joint_region(rig, "root", {0}, {kBendingAxis}), Error);
  EXPECT_THROW(make_joint_region(rig, "none", {}, {}), Error);
  EXPECT_THROW(make_joint_region(rig, "axes", {1}, {}), Error);
  EXPECT_THROW(make_joint_region(rig, "index", {7}, {kBendingAxis}), Error);
  try {
    make_joint_region(rig, "root", {0}, {kBendingAxis});
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("'lower'"), std::string::npos);
  }
}

}  // namespace
}  // namespace geoprior
