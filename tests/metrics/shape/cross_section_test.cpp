#include "metrics/shape/cross_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "metrics/shape/mid_ring.h"
#include "tests/metrics/motions.h"

namespace geoprior {
namespace {

using std::numbers::pi;
using Place = SectionRatio::Place;

const Eigen::Vector3d kFlexion(0, 1, 0);
const Eigen::Vector3d kTwist(1, 0, 0);

struct Tube {
  RiggedMesh rig = two_bone_cylinder();
  JointRegion region = make_joint_region(rig, "joint", {1}, {kFlexion});

  [[nodiscard]] std::vector<SectionRatio> sections(const Pose& pose) const {
    return cross_sections(region, rig.mesh.F, rig.mesh.V, motions::linear_blend(rig, pose), pose);
  }
};

TEST(CrossSection, IsOneAtRestForEverySection) {
  const Tube tube;
  const std::vector<SectionRatio> sections = tube.sections(rest_pose(2));
  EXPECT_EQ(sections.size(), 26u);  // no wedge in a straight joint
  for (const SectionRatio& s : sections) {
    if (s.s == 0) continue;  // half of the triangles in this plane belong to the other side
    ASSERT_TRUE(s.whole && s.outer && s.inner && s.outer_point);
    EXPECT_NEAR(*s.whole, 1, 1e-12);
    EXPECT_NEAR(*s.outer, 1, 1e-12);
    EXPECT_NEAR(*s.inner, 1, 1e-12);
    EXPECT_NEAR(*s.outer_point, 1, 1e-12);
  }
}

TEST(CrossSection, IsOneForEverySectionOfTheFingerAtRest) {
  const RiggedMesh rig = capsule_finger();
  const JointRegion region =
      make_joint_region(rig, "finger", {1, 2, 3}, {kFlexion, kFlexion, kFlexion});
  const std::vector<SectionRatio> sections =
      cross_sections(region, rig.mesh.F, rig.mesh.V, rig.mesh.V, rest_pose(4));
  EXPECT_EQ(sections.size(), 78u);
  for (const SectionRatio& s : sections) {
    if (s.s == 0) continue;
    ASSERT_TRUE(s.outer && s.inner) << "hinge " << s.hinge << ", s " << s.s;
    EXPECT_NEAR(*s.outer, 1, 1e-12);
    EXPECT_NEAR(*s.inner, 1, 1e-12);
  }
}

TEST(CrossSection, RigidMotionOfTheWholeBodyChangesNothing) {
  const Tube tube;
  Pose pose = rest_pose(2);
  const Eigen::Affine3d T =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(2, Eigen::Vector3d(1, 1, 0).normalized());
  pose[0] = pose[1] = T;
  const SectionSummary s = summarize(tube.sections(pose));
  // Round-off of coordinates of 3 m over a radius of 0.1 m.
  EXPECT_NEAR(s.shrink.value(), 1, 1e-9);
  EXPECT_NEAR(s.bulge.value(), 1, 1e-9);
  EXPECT_NEAR(s.elbow_collapse.value(), 1, 1e-9);
}

TEST(CrossSection, TwistedLinearBlendShrinksByCosSquaredOfHalfTheAngle) {
  Tube tube;
  tube.region.hinges.front().bend_axis.setZero();
  for (const double angle : {0.5, 1.5, 2.5}) {
    const Pose pose = motions::turned(angle, kTwist);
    const std::vector<SectionRatio> sections = tube.sections(pose);
    const double exact = std::pow(std::cos(angle / 2), 2);
    for (const SectionRatio& s : sections) {
      EXPECT_FALSE(s.outer || s.inner || s.outer_point);
      // The 48-gon turns by angle / 2 under 72 rays: the quadrature of its corners differs by less
      // than its sagitta, 2e-3 of the area; measured 1e-4.
      if (s.s == 0) {
        EXPECT_NEAR(s.whole.value(), exact, 5e-4);
      }
    }
    const SectionSummary summary = summarize(sections);
    EXPECT_NEAR(summary.shrink.value(), exact, 5e-4);
    EXPECT_FALSE(summary.outer_bulge || summary.elbow_collapse);
  }
}

TEST(CrossSection, BentLinearBlendCollapsesTheElbowToCosOfHalfTheAngle) {
  const Tube tube;
  for (const double angle : {0.6, -0.6, 1.2, pi / 2}) {
    const std::vector<SectionRatio> sections = tube.sections(motions::turned(angle, kFlexion));
    const double exact = std::cos(angle / 2);
    int wedges = 0;
    for (const SectionRatio& s : sections) {
      if (s.place != Place::wedge) continue;
      ++wedges;
      if (std::abs(s.s - 0.5) > 1e-12) continue;
      // The mid-ring lies in the bisector plane, an ellipse of half axes r cos(angle / 2) and r.
      EXPECT_NEAR(s.outer_point.value(), exact, 1e-9);
      EXPECT_NEAR(s.outer.value(), exact, 2.2e-3);  // sagitta of the 48-gon
    }
    EXPECT_EQ(wedges, 7);
    const SectionSummary summary = summarize(sections);
    EXPECT_LE(summary.elbow_collapse.value(), exact + 1e-9);
    EXPECT_LT(summary.shrink.value(), exact + 1e-3);
  }
}

TEST(CrossSection, BothSensesOfBendingGiveTheSame) {
  const Tube tube;
  const SectionSummary up = summarize(tube.sections(motions::turned(1.3, kFlexion)));
  const SectionSummary down = summarize(tube.sections(motions::turned(-1.3, kFlexion)));
  // The tube is symmetric under z -> -z up to the diagonals of its quads.
  EXPECT_NEAR(up.shrink.value(), down.shrink.value(), 2e-3);
  EXPECT_NEAR(up.bulge.value(), down.bulge.value(), 2e-3);
  EXPECT_NEAR(up.elbow_collapse.value(), down.elbow_collapse.value(), 1e-9);
}

TEST(CrossSection, TwoRigidLimbsThatMeetLoseNothing) {
  Tube tube;
  motions::make_rigid(tube.rig);
  for (const double angle : {pi / 3, pi / 2, 2.4}) {
    const std::vector<SectionRatio> sections = tube.sections(motions::turned(angle, kFlexion));
    int inner = 0;
    for (const SectionRatio& s : sections) {
      // The torn strip of triangles beside x = 0 belongs to the lower limb; the upper is rigid.
      if (s.place != Place::distal || s.s < 0.0126) continue;
      EXPECT_NEAR(s.outer.value(), 1, 1e-9);
      EXPECT_NEAR(s.outer_point.value(), 1, 1e-9);
      if (!s.inner) continue;
      ++inner;
      EXPECT_NEAR(*s.inner, 1, 1e-9);
    }
    EXPECT_GT(inner, 3) << "angle " << angle;
  }
}

TEST(CrossSection, InflationGrowsTheOuterHalfByItsSquare) {
  const Tube tube;
  Eigen::MatrixX3d posed = tube.rig.mesh.V;
  posed.rightCols(2) *= 1.1;
  const SectionSummary s =
      summarize(cross_sections(tube.region, tube.rig.mesh.F, tube.rig.mesh.V, posed, rest_pose(2)));
  EXPECT_NEAR(s.outer_bulge.value(), 0.21, 1e-9);
  EXPECT_NEAR(s.bulge.value(), 1.21, 1e-9);
  EXPECT_NEAR(s.shrink.value(), 1.21, 1e-9);
  EXPECT_NEAR(s.elbow_collapse.value(), 1.1, 1e-9);
}

TEST(CrossSection, HalvesAreToldApart) {
  // Flexion about +y carries +x towards -z: the outside is +z. Only that side is inflated. The
  // pose says a small flexion, so that the sense of the bend is known.
  const Tube tube;
  const Pose pose = motions::turned(1e-6, kFlexion);
  Eigen::MatrixX3d posed = tube.rig.mesh.V;
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    if (posed(v, 2) > 0) posed(v, 2) *= 1.2;
  }
  for (const SectionRatio& s :
       cross_sections(tube.region, tube.rig.mesh.F, tube.rig.mesh.V, posed, pose)) {
    if (s.s < 0.02) continue;  // the bisector plane is nearly the section's own there
    EXPECT_NEAR(s.outer.value(), 1.2, 2e-3);  // quadrature of the polygon by 37 rays
    EXPECT_NEAR(s.inner.value(), 1, 1e-3);
    EXPECT_NEAR(s.outer_point.value(), 1.2, 1e-4);
  }
}

TEST(CrossSection, WithoutSkinAllRoundIsNoLimbsAndHasNoHalves) {
  // The skin of the inner side is another part's between x = 0.1 and 0.15, as where fingers meet;
  // the rest of the outer side is drawn out there, as a web is by the bend.
  Tube tube;
  const Eigen::MatrixX3d& V = tube.rig.mesh.V;
  const auto middle = [&](int t) -> Eigen::RowVector3d {
    const auto corner = [&](int k) { return V.row(tube.rig.mesh.F(t, k)); };
    return (corner(0) + corner(1) + corner(2)) / 3;
  };
  std::erase_if(tube.region.triangles, [&](int t) {
    const Eigen::RowVector3d x = middle(t);
    return x.x() > 0.1 && x.x() < 0.15 && x.z() < -0.02;
  });
  Eigen::MatrixX3d posed = V;
  for (Eigen::Index v = 0; v < posed.rows(); ++v) {
    if (V(v, 0) > 0.11 && V(v, 0) < 0.14) posed(v, 1) *= 4;
  }
  const std::vector<SectionRatio> sections =
      cross_sections(tube.region, tube.rig.mesh.F, V, posed, rest_pose(2));
  int left_out = 0;
  for (const SectionRatio& s : sections) {
    if (s.place != Place::distal || s.s < 0.115 || s.s > 0.135) continue;
    EXPECT_FALSE(s.whole || s.outer || s.inner || s.outer_point) << s.s;
    ++left_out;
  }
  EXPECT_GT(left_out, 0);
  EXPECT_LT(summarize(sections).outer_bulge.value(), 0.5);
}

TEST(CrossSection, RefusesOptionsThatMakeNoSense) {
  const Tube tube;
  const auto with = [&](CrossSectionOptions options) {
    return cross_sections(tube.region, tube.rig.mesh.F, tube.rig.mesh.V, tube.rig.mesh.V,
                          rest_pose(2), options);
  };
  EXPECT_THROW(with({.directions = 70}), Error);
  EXPECT_THROW(with({.planes = 1}), Error);
}

TEST(MidRing, FollowsTheClosedFormsOfLinearBlending) {
  const Tube tube;
  const JointRegion::Hinge& hinge = tube.region.hinges.front();
  const std::vector<int> ring =
      find_mid_ring(hinge, tube.rig.mesh.V, region_vertices(tube.region, tube.rig.mesh.F));
  EXPECT_EQ(ring.size(), 48u);
  const auto ratio = [&](const Pose& pose) {
    return ring_radius_ratio(tube.rig.mesh.V, hinge.head, motions::linear_blend(tube.rig, pose),
                             hinge.head, ring);
  };
  for (const double angle : {0.4, 1.9, 3.0}) {
    // Round-off: the small half axis is the root of an eigenvalue of relative size 0.005.
    const RingRatio twist = ratio(motions::turned(angle, kTwist));
    const RingRatio bend = ratio(motions::turned(angle, kFlexion));
    EXPECT_NEAR(twist.min, std::cos(angle / 2), 1e-13);
    EXPECT_NEAR(twist.max, std::cos(angle / 2), 1e-13);
    EXPECT_NEAR(bend.min, std::cos(angle / 2), 1e-13);
    EXPECT_NEAR(bend.max, 1, 1e-13);
  }
}

TEST(MidRing, IsAbsentWhereTheTubeIsNotMadeByFormula) {
  Tube tube;
  const std::vector<int> vertices = region_vertices(tube.region, tube.rig.mesh.F);
  tube.rig.mesh.V.col(1) *= 1.001;  // no circle
  EXPECT_TRUE(find_mid_ring(tube.region.hinges.front(), tube.rig.mesh.V, vertices).empty());
  JointRegion::Hinge bent = tube.region.hinges.front();
  bent.distal = Eigen::Vector3d(1, 1, 0).normalized();
  EXPECT_TRUE(find_mid_ring(bent, two_bone_cylinder().mesh.V, vertices).empty());
}

}  // namespace
}  // namespace geoprior
