#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "baselines/skinning/dual_quaternion/dual_quaternion.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

/// The header's quotient for one vertex with one piece a triangle, every triangle visited.
Eigen::RowVector3d center_by_definition(const RiggedMesh& rig, const Eigen::MatrixXd& weights,
                                        int vertex, double sigma) {
  double mass = 0;
  Eigen::RowVector3d moment = Eigen::RowVector3d::Zero();
  for (Eigen::Index t = 0; t < rig.mesh.F.rows(); ++t) {
    const Eigen::RowVector3i f = rig.mesh.F.row(t);
    const Eigen::RowVector3d a = rig.mesh.V.row(f(0)), b = rig.mesh.V.row(f(1)),
                             c = rig.mesh.V.row(f(2));
    const Eigen::VectorXd mean = (weights.row(f(0)) + weights.row(f(1)) + weights.row(f(2))) / 3;
    const double s =
        weight_similarity(weights.row(vertex), mean, sigma) * (b - a).cross(c - a).norm() / 2;
    mass += s;
    moment += s * (a + b + c) / 3;
  }
  return mass > 0 ? Eigen::RowVector3d(moment / mass) : rig.mesh.V.row(vertex);
}

TEST(WeightSimilarity, IsSymmetricLargestAtEqualWeightsAndZeroWithoutTwoCommonJoints) {
  const Eigen::Vector3d a(0.5, 0.3, 0.2), b(0.2, 0.7, 0.1), one(0, 1, 0), other(0, 0.4, 0.6);
  EXPECT_DOUBLE_EQ(weight_similarity(a, b, 0.1), weight_similarity(b, a, 0.1));
  EXPECT_EQ(weight_similarity(a, one, 0.1), 0);
  EXPECT_EQ(weight_similarity(Eigen::Vector3d(0.6, 0.4, 0), other, 0.1), 0);
  // Two joints at equal weights w, 1 - w: 2 w^2 (1 - w)^2, the exponent is 0.
  const Eigen::Vector3d two(0.3, 0.7, 0);
  EXPECT_DOUBLE_EQ(weight_similarity(two, two, 0.1), 2 * 0.09 * 0.49);
  // With two joints a_1 b_2 - a_2 b_1 = a_1 - b_1.
  const Eigen::Vector3d near(0.4, 0.6, 0);
  EXPECT_NEAR(weight_similarity(two, near, 0.1), 2 * 0.21 * 0.24 * std::exp(-1), 1e-15);
}

TEST(CentersOfRotation, ListsOfPairsAgreeWithTheDefinition) {
  CentersOfRotationOptions options;
  options.weight_step = 1;
  options.weight_cell = 0;
  FingerOptions finger;
  finger.segments = 10;
  for (const RiggedMesh& rig : {capsule_finger(finger), fixtures::cylinder_of_many_influences(4)}) {
    const Eigen::MatrixX3d centers = centers_of_rotation(rig, options);
    const Eigen::MatrixXd weights = rig.weights;
    for (int v = 0; v < rig.mesh.vertex_count(); v += 7) {
      EXPECT_LE(
          (centers.row(v) - center_by_definition(rig, weights, v, options.similarity_width)).norm(),
          1e-12 * bounding_box_diagonal(rig.mesh.V))
          << v;
    }
  }
}

/// The tube with vertices moved along it by up to half the distance of rings: no two weights equal.
RiggedMesh irregular_tube() {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  RandomStream random(6, "rings");
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    rig.mesh.V(v, 0) += 0.0125 * (random.uniform() - 0.5);
    const double upper =
        std::clamp(0.5 + rig.mesh.V(v, 0) / cylinder_options().ramp_width, 0.0, 1.0);
    if (upper < 1) entries.emplace_back(v, 0, 1 - upper);
    if (upper > 0) entries.emplace_back(v, 1, upper);
  }
  rig.weights.setFromTriplets(entries.begin(), entries.end());
  return rig;
}

TEST(CentersOfRotation, CellsOfWeightMoveCentersByAThousandthOfTheRampAtMost) {
  CentersOfRotationOptions every;
  every.weight_cell = 0;
  const RiggedMesh rig = irregular_tube();
  const double moved =
      fixtures::largest_distance(centers_of_rotation(rig), centers_of_rotation(rig, every));
  EXPECT_GT(moved, 0);
  EXPECT_LE(moved, 1e-3 * cylinder_options().ramp_width);
}

// On a tube with the weight b = 1/2 + x / W the integral is one over b:
// p*_x / W = integral of b (1 - b) exp(-(a - b)^2 / sigma^2) (b - 1/2) / the same without (b -
// 1/2).
TEST(CentersOfRotation, OfATubeLieOnItsAxisWhereTheIntegralOverTheRampSays) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  CentersOfRotationOptions options;
  options.weight_step = 0.01;
  options.weight_cell = 0;
  const Eigen::MatrixX3d centers = centers_of_rotation(rig, options);
  int blended = 0;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double a = rig.weights.coeff(v, 1);
    if (a <= 0 || a >= 1) continue;
    ++blended;
    double mass = 0, moment = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double b = (k + 0.5) / kSteps;
      const double s = b * (1 - b) * std::exp(-std::pow((a - b) / options.similarity_width, 2));
      mass += s;
      moment += s * (b - 0.5);
    }
    const double x = cylinder_options().ramp_width * moment / mass;
    EXPECT_NEAR(centers(v, 0), x, 1e-4 * cylinder_options().ramp_width) << "weight " << a;
    EXPECT_NEAR(std::hypot(centers(v, 1), centers(v, 2)), 0, 1e-12);
  }
  EXPECT_GT(blended, 100);
}

TEST(CentersOfRotation, RestPoseReturnsTheInput) {
  EXPECT_LE(fixtures::rest_pose_error<CentersOfRotation>(), 1e-15);
}

TEST(CentersOfRotation, VerticesOfOneJointFollowItAlsoWhereItScales) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  Pose pose = fixtures::turned(rig, "upper", "flexion", 1.1);
  pose[1] = pose[1] * Eigen::Scaling(1.3, 0.8, 1.1);
  const Eigen::MatrixX3d posed = fixtures::deformed<CentersOfRotation>(rig, pose);
  int rigid = 0;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    if (rig.weights.coeff(v, 1) < 1) continue;
    ++rigid;
    const Eigen::Vector3d expected = pose[1] * Eigen::Vector3d(rig.mesh.V.row(v));
    EXPECT_LE((posed.row(v).transpose() - expected).norm(), 1e-14) << v;
  }
  EXPECT_GT(rigid, 100);
}

TEST(CentersOfRotation, TurnsWithARigidMotionOfAllJoints) {
  const RiggedMesh rig = capsule_finger();
  const CentersOfRotation method(rig);
  const Pose pose = fixtures::curled(rig, 0.9);
  Eigen::MatrixX3d still, moved;
  method.deform(pose, still);
  for (const double angle : {0.3, 2.0, 3.1, 5.5}) {
    const Eigen::Affine3d motion = Eigen::Translation3d(1, -2, 3) *
                                   Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 1, 2).normalized());
    Pose turned = pose;
    for (Eigen::Affine3d& transform : turned) transform = motion * transform;
    method.deform(turned, moved);
    const Eigen::MatrixX3d expected =
        (still * motion.linear().transpose()).rowwise() + motion.translation().transpose();
    EXPECT_LE(fixtures::largest_distance(moved, expected), 1e-13) << angle;
  }
}

// Centers on the axis of a twist stay where they are and rings turn about them.
TEST(CentersOfRotation, TwistKeepsTheRadiusOfEveryRing) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const CentersOfRotation method(rig);
  Eigen::MatrixX3d posed;
  for (const double degrees : {10.0, 45.0, 90.0, 135.0, 170.0, 179.0}) {
    method.deform(fixtures::turned(rig, "upper", "twist", degrees * kDegree), posed);
    for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
      const double radius = std::hypot(rig.mesh.V(v, 1), rig.mesh.V(v, 2));
      EXPECT_NEAR(std::hypot(posed(v, 1), posed(v, 2)), radius, 1e-12) << degrees;
      EXPECT_NEAR(posed(v, 0), rig.mesh.V(v, 0), 1e-12) << degrees;
    }
  }
}

// The mid-ring's center is the joint itself: the ring turns by half the angle and keeps its shape
// (linear blend: an ellipse of half axes r cos(theta / 2) and r).
TEST(CentersOfRotation, BendTurnsTheMidRingByHalfTheAngle) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const CentersOfRotation method(rig);
  Eigen::MatrixX3d posed;
  for (const double degrees : {10.0, 60.0, 120.0, 160.0}) {
    method.deform(fixtures::turned(rig, "upper", "flexion", degrees * kDegree), posed);
    const Eigen::AngleAxisd half(degrees / 2 * kDegree, Eigen::Vector3d::UnitY());
    for (const int v : mid_ring(cylinder_options())) {
      const Eigen::Vector3d expected = half * Eigen::Vector3d(rig.mesh.V.row(v));
      EXPECT_LE((posed.row(v).transpose() - expected).norm(), 1e-7) << degrees;
    }
  }
}

// Dual quaternions move blended rings on circles about the joint, which bulges; centers of rotation
// take the chord: the outer side is never farther from the joint.
TEST(CentersOfRotation, BendBulgesLessThanDualQuaternions) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 90 * kDegree);
  const Eigen::MatrixX3d posed = fixtures::deformed<CentersOfRotation>(rig, pose);
  const Eigen::MatrixX3d circles = fixtures::deformed<DualQuaternionBlend>(rig, pose);
  double most = 0;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const double w = rig.weights.coeff(v, 1);
    if (w <= 0 || w >= 1 || rig.mesh.V(v, 2) < 0.9 * cylinder_options().radius) continue;
    const double less = circles.row(v).norm() - posed.row(v).norm();
    EXPECT_GE(less, -1e-7) << v;
    most = std::max(most, less);
  }
  EXPECT_GT(most, 0.03 * cylinder_options().radius);
}

TEST(CentersOfRotation, LanesAgreeWithTheFormula) {
  for (int copies = 1; copies <= 5; ++copies) {
    const RiggedMesh rig = fixtures::cylinder_of_many_influences(copies);
    Pose pose = fixtures::turned(rig, "upper", "flexion", 1.1);
    for (std::size_t j = 2; j < pose.size(); ++j) {
      const Eigen::Vector3d axis(1, 0.2 * static_cast<double>(j), -0.3);
      pose[j] = Eigen::AngleAxisd(0.4 * static_cast<double>(j), axis.normalized()) * pose[1];
    }
    const CentersOfRotation method(rig);
    Eigen::MatrixX3d posed;
    method.deform(pose, posed);
    // Weights are packed as floats: 6e-8 of the distances, which are below 2 m.
    EXPECT_LE(fixtures::largest_distance(posed, blend_about_centers(rig, method.centers(), pose)),
              2e-7)
        << copies;
  }
}

TEST(CentersOfRotation, SameBitsForOneAndTwoThreads) {
  CylinderOptions options;
  options.segments = 96;
  const RiggedMesh rig = two_bone_cylinder(options);
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.3);
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { CentersOfRotation(rig).deform(pose, one); });
  with_threads(2, [&] { CentersOfRotation(rig).deform(pose, two); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST(CentersOfRotation, RefusesWrongInput) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const CentersOfRotation method(rig);
  Eigen::MatrixX3d posed;
  EXPECT_THROW(method.deform(rest_pose(1), posed), Error);
  Pose pose = rest_pose(2);
  pose[1].translation().x() = std::nan("");
  EXPECT_THROW(method.deform(pose, posed), Error);
  EXPECT_THROW(blend_about_centers(rig, method.centers().topRows(3), rest_pose(2)), Error);
  EXPECT_THROW(weight_similarity(Eigen::Vector2d(0.5, 0.5), Eigen::Vector3d::Zero(), 0.1), Error);
  EXPECT_THROW(weight_similarity(Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(0.5, 0.5), 0), Error);
  for (const double sigma : {0.0, -1.0, std::nan("")}) {
    CentersOfRotationOptions options;
    options.similarity_width = sigma;
    EXPECT_THROW(CentersOfRotation(rig, options), Error) << sigma;
  }
  for (const double step : {0.0, 1.5, std::nan("")}) {
    CentersOfRotationOptions options;
    options.weight_step = step;
    EXPECT_THROW(CentersOfRotation(rig, options), Error) << step;
  }
  for (const double cell : {-0.1, 0.5, std::nan("")}) {
    CentersOfRotationOptions options;
    options.weight_cell = cell;
    EXPECT_THROW(CentersOfRotation(rig, options), Error) << cell;
  }
  RiggedMesh nan = rig;
  nan.mesh.V(5, 1) = std::nan("");
  EXPECT_THROW(CentersOfRotation{nan}, Error);
  rig.weights *= 0.5;
  EXPECT_THROW(CentersOfRotation{rig}, Error);
}

}  // namespace
}  // namespace geoprior::skinning
