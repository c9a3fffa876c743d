#include "experiments/skinning/weights/bounded_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "experiments/skinning/weights/bone_contacts.h"
#include "experiments/skinning/weights/box_program.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

CylinderOptions tube_options() { return fixtures::fine_cylinder_options(32, 100); }

/// Half of the weight's profile across a straight joint, v(s) = weight of the other bone at s = x /
/// (sqrt(2) l): v'''' = -4 v up to the contact s0 with v = v' = v'' = 0, and v(0) = 1/2, v''(0) =
/// 0.
class ObstacleProfile {
 public:
  ObstacleProfile() {
    double low = 2, high = 3;  // tan s + tanh s is negative at 2, positive at 3
    for (int i = 0; i < 60; ++i) {
      contact_ = (low + high) / 2;
      (std::tan(contact_) + std::tanh(contact_) < 0 ? low : high) = contact_;
    }
    const double ch = std::cosh(contact_), sh = std::sinh(contact_);
    const double c = std::cos(contact_), s = std::sin(contact_);
    // a and b from v(s0) = v'(s0) = 0.
    const double m00 = ch * s, m01 = sh * c, m10 = sh * s + ch * c, m11 = ch * c - sh * s;
    const double r0 = -ch * c / 2, r1 = -(sh * c - ch * s) / 2;
    const double determinant = m00 * m11 - m01 * m10;
    a_ = (r0 * m11 - m01 * r1) / determinant;
    b_ = (m00 * r1 - m10 * r0) / determinant;
  }
  [[nodiscard]] double contact() const { return contact_; }
  /// v''(s0): 0 for the solution.
  [[nodiscard]] double curvature_at_contact() const {
    const double ch = std::cosh(contact_), sh = std::sinh(contact_);
    return -sh * std::sin(contact_) + 2 * a_ * sh * std::cos(contact_) -
           2 * b_ * ch * std::sin(contact_);
  }
  [[nodiscard]] double other_bone(double s) const {
    if (s >= contact_) return 0;
    return std::cosh(s) * std::cos(s) / 2 + a_ * std::cosh(s) * std::sin(s) +
           b_ * std::sinh(s) * std::cos(s);
  }

 private:
  double contact_ = 0, a_ = 0, b_ = 0;
};

// The energy's minimiser on a long tube is the solution of a one-dimensional obstacle problem;
// where the constraint binds its second derivative is continuous.
TEST(BoundedWeights, SolveTheObstacleProblemOfATube) {
  const ObstacleProfile profile;
  ASSERT_NEAR(profile.curvature_at_contact(), 0, 1e-9);
  const RiggedMesh rig = two_bone_cylinder(tube_options());
  for (const double length : {0.5, 1.0}) {
    const SkinWeights weights = bounded_weights(rig.mesh, rig.skeleton, {.length = length});
    const double scale = std::sqrt(2.0) * length * tube_options().radius;
    double worst = 0;
    for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
      const double x = rig.mesh.V(v, 0);
      if (x < 0 || x > 0.3) continue;  // away from the caps
      worst = std::max(worst, std::abs(weights.coeff(v, 0) - profile.other_bone(x / scale)));
    }
    // Linear elements of h = r / 10: second order, (h / l)^2 / 6 = 7e-3 and 2e-3, and the
    // tolerance.
    EXPECT_LE(worst, std::pow(0.1 / length, 2) / 6 + 1e-3) << length;
  }
}

TEST(BoundedWeights, AreExactlyZeroBeyondTheContact) {
  const ObstacleProfile profile;
  const RiggedMesh rig = two_bone_cylinder(tube_options());
  const SkinWeights weights = bounded_weights(rig.mesh, rig.skeleton, {.length = 1});
  const double contact = profile.contact() * std::sqrt(2.0) * tube_options().radius;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double x = rig.mesh.V(v, 0);
    if (x < 1.2 * contact) continue;
    EXPECT_EQ(weights.coeff(v, 0), 0) << x;
    EXPECT_EQ(weights.coeff(v, 1), 1) << x;
  }
}

TEST(BoundedWeights, AreBoundedPartitionsOfUnityWithAtMostTheAskedInfluences) {
  const RiggedMesh finger = capsule_finger();
  for (const int influences : {0, 1, 2, 4}) {
    const SkinWeights weights =
        bounded_weights(finger.mesh, finger.skeleton, {.max_influences = influences});
    for (int v = 0; v < finger.mesh.vertex_count(); ++v) {
      EXPECT_NEAR(weights.row(v).sum(), 1, 1e-14);
      EXPECT_LE(weights.row(v).nonZeros(), influences > 0 ? influences : 4);
      for (SkinWeights::InnerIterator it(weights, v); it; ++it) {
        EXPECT_GT(it.value(), 0);
        EXPECT_LE(it.value(), 1);
      }
    }
  }
}

// Of two bones one is what the other leaves, so that each program alone gives a partition of unity.
TEST(BoundedWeights, OfTwoBonesSumToOneWithoutBeingTold) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const BoxSolution solution = bounded_biharmonic(rig.mesh, bones_of(rig.skeleton), {});
  EXPECT_LE((solution.X.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-9);
}

// Optimality conditions of a bounded convex program; solutions within the bounds that meet them are
// the minimiser.
TEST(BoundedWeights, MeetTheOptimalityConditions) {
  const RiggedMesh finger = capsule_finger();
  const BoxSolution solution = bounded_biharmonic(finger.mesh, bones_of(finger.skeleton), {});
  EXPECT_GE(solution.X.minCoeff(), 0);
  EXPECT_LE(solution.X.maxCoeff(), 1);
  EXPECT_GT(solution.pivots, 1);  // without the bounds the solution overshoots
  EXPECT_LE(solution.residual, 1e-10);
}

TEST(BoundedWeights, MirrorTheSymmetryOfTheCylinder) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const SkinWeights weights = bounded_weights(rig.mesh, rig.skeleton);
  for (const int v : mid_ring(cylinder_options())) EXPECT_NEAR(weights.coeff(v, 0), 0.5, 1e-9);
  const int rings = (rig.mesh.vertex_count() - 2) / cylinder_options().segments;
  for (int i = 0; i < rings; ++i) {
    const int v = 1 + i * cylinder_options().segments;
    const int mirrored = 1 + (rings - 1 - i) * cylinder_options().segments;
    EXPECT_NEAR(weights.coeff(v, 0), weights.coeff(mirrored, 1), 1e-9) << i;
  }
}

TEST(BoundedWeights, AreTheSameBytesAtAnyThreadCount) {
  const RiggedMesh finger = capsule_finger();
  SkinWeights one, two;
  with_threads(1, [&] { one = bounded_weights(finger.mesh, finger.skeleton); });
  with_threads(2, [&] { two = bounded_weights(finger.mesh, finger.skeleton); });
  ASSERT_EQ(one.nonZeros(), two.nonZeros());
  for (Eigen::Index i = 0; i < one.nonZeros(); ++i) {
    EXPECT_EQ(one.valuePtr()[i], two.valuePtr()[i]);
    EXPECT_EQ(one.innerIndexPtr()[i], two.innerIndexPtr()[i]);
  }
}

std::string error_of(const RiggedMesh& rig, const BoundedWeightsOptions& options) {
  try {
    bounded_weights(rig.mesh, rig.skeleton, options);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

// The unconstrained solution, (34, -8) / 15, is clamped to (1, 0), where the second multiplier has
// the wrong sign: the active set changes once more, to (1, 1/10).
TEST(BoxProgram, IsRefusedWhenItsActiveSetDoesNotSettle) {
  const Eigen::Matrix2d Q{{1, 0.5}, {0.5, 1}};
  const BoxProgram program{Q.sparseView(), Eigen::Vector2d(2, 0.6)};
  EXPECT_TRUE(solve_in_box(program, 2).X.isApprox(Eigen::Vector2d(1, 0.1), 1e-12));
  std::string error;
  try {
    solve_in_box(program, 1);
  } catch (const Error& e) {
    error = e.what();
  }
  EXPECT_THAT(error, testing::HasSubstr("not found in 1 changes of the active set"));
}

TEST(BoundedWeights, RefuseWrongInput) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  EXPECT_NE(error_of(rig, {.length = 0}), "");
  EXPECT_NE(error_of(rig, {.max_influences = -1}), "");
  const TriMesh flat{Eigen::MatrixX3d::Zero(3, 3), Eigen::MatrixX3i(Eigen::RowVector3i(0, 1, 2))};
  EXPECT_THROW(bounded_weights(flat, rig.skeleton), Error);
  rig.mesh.V(3, 1) = std::nan("");
  EXPECT_NE(error_of(rig, {}), "");
}

}  // namespace
}  // namespace geoprior::skinning
