#include "experiments/skinning/weights/narrow_weights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

CylinderOptions fine_tube() { return fixtures::fine_cylinder_options(96, 120); }

double smoothstep_across(double x, double width) {
  const double t = std::clamp(0.5 + x / width, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

TEST(NarrowWeights, ArePartitionsOfUnityWithAtMostTheAskedInfluences) {
  const RiggedMesh finger = capsule_finger();
  for (const int influences : {0, 1, 2, 4}) {
    const SkinWeights weights =
        narrow_weights(finger.mesh, finger.skeleton, {.max_influences = influences});
    for (int v = 0; v < finger.mesh.vertex_count(); ++v) {
      EXPECT_NEAR(weights.row(v).sum(), 1, 1e-14);
      EXPECT_LE(weights.row(v).nonZeros(), influences > 0 ? influences : 4);
      for (SkinWeights::InnerIterator it(weights, v); it; ++it) EXPECT_GT(it.value(), 0);
    }
  }
}

// Across the straight border of a tube's halves the blurred skin is 1 - exp(-x / l) / 2, its
// logarithm the distance x, and the weight a smoothstep over width times the radius.
TEST(NarrowWeights, AreASmoothstepOfTheStatedWidthOnATube) {
  const CylinderOptions tube = fine_tube();
  const RiggedMesh rig = two_bone_cylinder(tube);
  for (const double width : {0.5, 1.0, 2.0}) {
    const SkinWeights weights = narrow_weights(rig.mesh, rig.skeleton, {.width = width});
    double worst = 0;
    for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
      const double x = rig.mesh.V(v, 0);
      if (std::abs(x) > 0.3) continue;  // away from the caps
      const double expected = smoothstep_across(x, width * tube.radius);
      worst = std::max(worst, std::abs(weights.coeff(v, 1) - expected));
    }
    // Elements of h = r / 12 take exp(-x / l) to be exp(-k x) with cosh(k h) = 1 + (h / l)^2 / 2,
    // k l = 1 - (h / l)^2 / 24; slope of the smoothstep 1.5 / width, at x = width / 4.
    const double h_over_l = 3 / (12 * width);
    EXPECT_LE(worst, h_over_l * h_over_l / 24 + 1e-3) << width;
  }
}

TEST(NarrowWeights, MirrorTheSymmetryOfTheCylinder) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const SkinWeights weights = narrow_weights(rig.mesh, rig.skeleton);
  for (const int v : mid_ring(cylinder_options())) EXPECT_NEAR(weights.coeff(v, 0), 0.5, 1e-9);
  const int rings = (rig.mesh.vertex_count() - 2) / cylinder_options().segments;
  for (int i = 0; i < rings; ++i) {
    const int v = 1 + i * cylinder_options().segments;
    const int mirrored = 1 + (rings - 1 - i) * cylinder_options().segments;
    EXPECT_NEAR(weights.coeff(v, 0), weights.coeff(mirrored, 1), 1e-9) << i;
  }
}

/// A mitred tube: the lower half, its rings tilted up to the plane x = z tan(angle / 2) at the
/// joint, and its mirror image in that plane as the upper half.
RiggedMesh mitred(double degrees) {
  const CylinderOptions tube = fine_tube();
  RiggedMesh rig = two_bone_cylinder(tube);
  const double tilt = degrees / 2 * std::acos(-1.0) / 180;
  const Eigen::Vector3d normal(std::cos(tilt), 0, -std::sin(tilt));
  const auto mirror = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return x - 2 * normal.dot(x) * normal;
  };
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    Eigen::Vector3d x = rig.mesh.V.row(v);
    const bool upper = x.x() > 0;
    if (upper) x.x() = -x.x();
    x.x() += std::tan(tilt) * x.z() * (1 + x.x() / tube.half_length);
    rig.mesh.V.row(v) = (upper ? mirror(x) : x).transpose();
  }
  rig.skeleton.joints[1].tail = mirror(rig.skeleton.joints[0].head);
  return rig;
}

// Skin that is equally near to both bones, outside a bent joint, is parted by the bisector plane.
TEST(NarrowWeights, PartTheOuterSideOfABentJointByItsBisectorPlane) {
  const RiggedMesh rig = mitred(60);
  const SkinWeights weights = narrow_weights(rig.mesh, rig.skeleton);
  const double tilt = std::acos(-1.0) / 6;
  const Eigen::Vector3d normal(std::cos(tilt), 0, -std::sin(tilt));
  int near = 0;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const Eigen::Vector3d x = rig.mesh.V.row(v);
    const double side = normal.dot(x);
    if (x.norm() > 0.12) continue;
    ++near;
    if (std::abs(side) < 1e-9) {
      EXPECT_NEAR(weights.coeff(v, 1), 0.5, 0.02) << x.transpose();
    } else {
      EXPECT_EQ(weights.coeff(v, 1) > 0.5, side > 0) << x.transpose();
    }
  }
  EXPECT_GT(near, 1000);
}

TEST(NarrowWeights, AreTheSameBytesAtAnyThreadCount) {
  const RiggedMesh finger = capsule_finger();
  SkinWeights one, two;
  with_threads(1, [&] { one = narrow_weights(finger.mesh, finger.skeleton); });
  with_threads(2, [&] { two = narrow_weights(finger.mesh, finger.skeleton); });
  ASSERT_EQ(one.nonZeros(), two.nonZeros());
  for (Eigen::Index i = 0; i < one.nonZeros(); ++i) {
    EXPECT_EQ(one.valuePtr()[i], two.valuePtr()[i]);
    EXPECT_EQ(one.innerIndexPtr()[i], two.innerIndexPtr()[i]);
  }
}

TEST(NarrowWeights, RefuseWrongInput) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  EXPECT_THROW(narrow_weights(rig.mesh, rig.skeleton, {.width = 0}), Error);
  EXPECT_THROW(narrow_weights(rig.mesh, rig.skeleton, {.max_influences = -1}), Error);
  const TriMesh flat{Eigen::MatrixX3d::Zero(3, 3), Eigen::MatrixX3i(Eigen::RowVector3i(0, 1, 2))};
  EXPECT_THROW(narrow_weights(flat, rig.skeleton), Error);
  rig.mesh.V(3, 1) = std::nan("");
  EXPECT_THROW(narrow_weights(rig.mesh, rig.skeleton), Error);
  rig = two_bone_cylinder(cylinder_options());
  for (Joint& joint : rig.skeleton.joints) joint.tail.reset();
  EXPECT_THROW(narrow_weights(rig.mesh, rig.skeleton), Error);
}

}  // namespace
}  // namespace geoprior::skinning
