#include "metrics/contact/harm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "tests/metrics/motions.h"

namespace geoprior {
namespace {

const Eigen::Vector3d kAcross(0, 1, 0);

TEST(BoneRings, OfACylinderHaveItsRadius) {
  const RiggedMesh rig = two_bone_cylinder();
  const double radius = CylinderOptions().radius;
  const BoneRings rings(rig);
  const Eigen::VectorXd radii = rings.radii();
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double from_axis = rig.mesh.V.row(v).tail(2).norm();
    if (from_axis < 0.99 * radius) continue;  // the ends are closed by vertices nearer to the axis
    ASSERT_TRUE(rings.radius(v)) << v;
    EXPECT_EQ(radii(v), *rings.radius(v));
    EXPECT_LE(*rings.radius(v), radius + 1e-12);
    const bool near_an_end = std::abs(rig.mesh.V(v, 0)) > CylinderOptions().half_length - radius;
    if (!near_an_end) {
      EXPECT_NEAR(*rings.radius(v), radius, 1e-12);
    }
  }
}

TEST(BoneRings, SectionsFollowInflationAndNotRigidMotion) {
  const RiggedMesh rig = two_bone_cylinder();
  const BoneRings rings(rig);
  const Pose pose = motions::turned(0.7, kAcross);
  RiggedMesh rigid = rig;
  motions::make_rigid(rigid);
  Eigen::MatrixX3d inflated = rig.mesh.V;
  inflated.rightCols(2) *= 1.1;
  const Eigen::VectorXd grown = rings.section_ratios(inflated, rest_pose(2));
  // The rings of a vertex between two bones of equal weight are those of the first: leave it out.
  const Eigen::VectorXd turned = rings.section_ratios(motions::linear_blend(rigid, pose), pose);
  for (int v = 0; v < rings.vertex_count(); ++v) {
    if (!rings.radius(v)) continue;
    EXPECT_NEAR(grown(v), 1.21, 1e-12);
    if (std::abs(rig.mesh.V(v, 0)) > 0.1) {
      EXPECT_NEAR(turned(v), 1, 1e-9);
    }
  }
  EXPECT_THROW((void)rings.section_ratios(inflated.topRows(3), rest_pose(2)), Error);
}

TEST(Harm, IsTheLargestDisplacementOverTheRadiusWhereNothingIsAsked) {
  const RiggedMesh rig = two_bone_cylinder();
  const BoneRings rings(rig);
  const Eigen::MatrixX3d& plain = rig.mesh.V;
  const std::vector<int> unasked = unasked_vertices(rings, rig.mesh.F, plain, rest_pose(2), {});
  const auto v = std::find_if(unasked.begin(), unasked.end(), [&](int u) {
    return plain(u, 0) > 0.1 && plain.row(u).tail(2).norm() > 0.99 * CylinderOptions().radius;
  });
  ASSERT_NE(v, unasked.end());
  Eigen::MatrixX3d moved = plain;
  moved(*v, 1) += 0.03;
  const Harm found = harm(rings, unasked, moved, plain).value();
  EXPECT_NEAR(found.max, 0.03 / *rings.radius(*v), 1e-12);
  EXPECT_GT(found.unasked_share, 0.95);
  EXPECT_EQ(harm(rings, unasked, plain, plain)->max, 0);
  EXPECT_FALSE(harm(rings, {}, moved, plain).has_value());
  EXPECT_THROW((void)harm(rings, unasked, moved.topRows(3), plain), Error);
}

TEST(Harm, IsNotMeasuredNearAnOverlapNorWhereTheSectionChanged) {
  const RiggedMesh rig = two_bone_cylinder();
  const BoneRings rings(rig);
  const Eigen::MatrixX3d& plain = rig.mesh.V;
  const double radius = CylinderOptions().radius;
  int triangle = 0;  // on the straight part of a limb
  while (std::abs(plain(rig.mesh.F(triangle, 0), 0) - 0.25) > 0.02) ++triangle;
  const std::vector<int> near_overlap =
      unasked_vertices(rings, rig.mesh.F, plain, rest_pose(2), {triangle});
  const Eigen::RowVector3d corner = plain.row(rig.mesh.F(triangle, 0));
  EXPECT_FALSE(near_overlap.empty());
  for (const int v : near_overlap) EXPECT_GE((plain.row(v) - corner).norm(), radius * (1 - 1e-12));
  const std::vector<int> all = unasked_vertices(rings, rig.mesh.F, plain, rest_pose(2), {});
  for (const int v : all) {
    const bool is_left_out = !std::binary_search(near_overlap.begin(), near_overlap.end(), v);
    if (is_left_out) {
      EXPECT_LT((plain.row(v) - corner).norm(), radius * 1.5);
    }
  }
  // The half x > 0 swells by 3 % in area: nothing there is unasked.
  Eigen::MatrixX3d swollen = plain;
  for (Eigen::Index v = 0; v < swollen.rows(); ++v) {
    if (plain(v, 0) > 0) swollen.row(v).tail(2) *= std::sqrt(1.03);
  }
  const double slice = radius / 3;
  for (const int v : unasked_vertices(rings, rig.mesh.F, swollen, rest_pose(2), {})) {
    EXPECT_LT(plain(v, 0), slice);
  }
}

}  // namespace
}  // namespace geoprior
