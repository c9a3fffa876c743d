#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "baselines/skinning/direct_delta_mush/implicit_smoothing.h"
#include "baselines/skinning/linear_blend/linear_blend.h"
#include "baselines/skinning/shared/rotation_lanes.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"
#include "models/skinning/surface_diffusion.h"
#include "tests/skinning/fixtures.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

FingerOptions coarse_finger() {
  FingerOptions options;
  options.segments = 10;
  return options;
}

/// (I + length D^-1 L)^-steps, dense.
Eigen::MatrixXd smoothing_matrix(const TriMesh& mesh, double length, int steps) {
  const Eigen::MatrixXd L = positive_cotangent_laplacian(mesh);
  Eigen::MatrixXd one = length * L.diagonal().cwiseInverse().asDiagonal() * L;
  one.diagonal().array() += 1;
  const Eigen::MatrixXd inverse = one.inverse();
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(one.rows(), one.cols());
  for (int step = 0; step < steps; ++step) result = inverse * result;
  return result;
}

Eigen::Matrix3d polar_rotation(const Eigen::Matrix3d& S) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(S, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

/// The paper's variant 0 as it is written, with dense smoothing matrices and 4 x 4 matrices that
/// are not shifted.
Eigen::MatrixX3d paper_definition(const RiggedMesh& rig, const Pose& pose,
                                  const DirectDeltaMushOptions& o) {
  const Eigen::MatrixXd B = smoothing_matrix(rig.mesh, o.lambda, o.iterations);
  const Eigen::MatrixXd carried =
      smoothing_matrix(rig.mesh, o.kappa, o.iterations) * Eigen::MatrixXd(rig.weights);
  const Eigen::Index n = rig.mesh.V.rows();
  Eigen::MatrixX4d U(n, 4);
  U << rig.mesh.V, Eigen::VectorXd::Ones(n);
  Eigen::MatrixX3d posed(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector4d p = (B.row(i) * U).transpose() / B.row(i).sum();
    Eigen::Matrix4d Q = Eigen::Matrix4d::Zero();
    for (int j = 0; j < rig.skeleton.size(); ++j) {
      const Eigen::VectorXd share =
          B.row(i).transpose().cwiseProduct(Eigen::VectorXd(rig.weights.col(j)));
      const Eigen::Matrix4d psi = U.transpose() * share.asDiagonal() * U;
      Q += pose[j].matrix() * ((1 - o.alpha) * psi + o.alpha * carried(i, j) * p * p.transpose());
    }
    const Eigen::Vector3d q = Q.topRightCorner<3, 1>();
    const Eigen::Matrix3d R =
        polar_rotation(Q.topLeftCorner<3, 3>() - q * Q.bottomLeftCorner<1, 3>());
    posed.row(i) = q + R * (rig.mesh.V.row(i).transpose() - p.head<3>());
  }
  return posed;
}

TEST(NearestRotations, AgreeWithTheSingularValueDecomposition) {
  RandomStream random(4, "matrices");
  for (int round = 0; round < 2000; ++round) {
    Eigen::Matrix3d A[4];
    lanes::Matrices lanes_of;
    for (int l = 0; l < 4; ++l) {
      Eigen::Quaterniond u(random.normal(), random.normal(), random.normal(), random.normal());
      Eigen::Quaterniond v(random.normal(), random.normal(), random.normal(), random.normal());
      // Of every shape and sign; flat ones as patches of skin are, turned by half turns as well.
      Eigen::Vector3d sigma(1, 0.02 + 0.98 * random.uniform(), 0);
      if (round % 4 == 1) sigma(2) = sigma(1) * random.uniform();
      if (round % 4 == 2) sigma(2) = -0.9 * sigma(1) * random.uniform();
      if (round % 8 == 3) v = u * Eigen::Quaterniond(0, 1, 0, 0);
      A[l] = std::pow(10, 8 * random.uniform() - 6) * u.normalized().toRotationMatrix() *
             sigma.asDiagonal() * v.normalized().toRotationMatrix().transpose();
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) lanes_of.m[i][j][l] = A[l](i, j);
      }
    }
    const lanes::Matrices R = lanes::nearest_rotations(lanes_of);
    for (int l = 0; l < 4; ++l) {
      const Eigen::Matrix3d expected = polar_rotation(A[l]);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
          EXPECT_NEAR(R.m[i][j][l], expected(i, j), 1e-10) << "matrix\n" << A[l];
      }
    }
  }
}

TEST(ImplicitSmoothing, AgreesWithTheDenseInverse) {
  const RiggedMesh rig = capsule_finger(coarse_finger());
  RandomStream random(9, "values");
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(
      rig.mesh.vertex_count(), 14);  // more columns than are solved together
  for (double& x : values.reshaped()) x = random.normal();
  const Eigen::MatrixXd expected = smoothing_matrix(rig.mesh, 2.5, 7) * values;
  ImplicitSmoothing(rig.mesh, 2.5, 7).apply(values);
  EXPECT_LE((values - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DirectDeltaMush, AgreesWithThePapersDefinition) {
  const RiggedMesh rig = capsule_finger(coarse_finger());
  for (const double alpha : {0.0, 0.8, 0.95}) {
    DirectDeltaMushOptions options;
    options.iterations = 6;
    options.alpha = alpha;
    options.smallest_influence = 0;
    const Pose pose = fixtures::curled(rig, 0.9);
    const Eigen::MatrixX3d expected = paper_definition(rig, pose, options);
    const double size = bounding_box_diagonal(rig.mesh.V);
    const DirectDeltaMushMatrices matrices = direct_delta_mush_matrices(rig, options);
    // What is added to degenerate patches: a millionth of a patch.
    EXPECT_LE(fixtures::largest_distance(direct_delta_mush(rig, matrices, pose), expected),
              1e-6 * size)
        << alpha;
    Eigen::MatrixX3d posed;
    DirectDeltaMush(rig, options).deform(pose, posed);
    EXPECT_LE(fixtures::largest_distance(posed, expected), 1e-6 * size) << alpha;
  }
}

TEST(DirectDeltaMush, LanesAgreeWithTheFormula) {
  const RiggedMesh rig = capsule_finger();
  const DirectDeltaMush method(rig);
  const DirectDeltaMushMatrices matrices = direct_delta_mush_matrices(rig);
  for (const double angle : {0.3, 0.9, 1.5}) {
    const Pose pose = fixtures::curled(rig, angle);
    Eigen::MatrixX3d posed;
    method.deform(pose, posed);
    // Matrices are packed as floats.
    EXPECT_LE(fixtures::largest_distance(posed, direct_delta_mush(rig, matrices, pose)),
              1e-6 * bounding_box_diagonal(rig.mesh.V))
        << angle;
  }
}

TEST(DirectDeltaMush, MatricesOfAVertexSumToOneMotion) {
  const RiggedMesh rig = capsule_finger();
  const DirectDeltaMushMatrices m = direct_delta_mush_matrices(rig);
  for (std::size_t i = 0; i + 1 < m.offset.size(); ++i) {
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    double share = 0;
    for (std::size_t e = m.offset[i]; e < m.offset[i + 1]; ++e) {
      offset += m.matrices[e].offset;
      share += m.matrices[e].share;
      EXPECT_GE(m.matrices[e].share, 0) << i;
    }
    EXPECT_NEAR(share, 1, 1e-15) << i;
    EXPECT_LE(offset.norm(), 1e-17) << i;
  }
}

TEST(DirectDeltaMush, RestPoseReturnsTheInput) {
  CylinderOptions flat = cylinder_options();
  flat.cap_height = 0;
  for (const RiggedMesh& rig :
       {two_bone_cylinder(flat), capsule_finger(), fixtures::cylinder_of_many_influences(5)}) {
    const Eigen::MatrixX3d posed =
        fixtures::deformed<DirectDeltaMush>(rig, rest_pose(rig.skeleton.size()));
    // Offsets are packed as floats: 6e-8 of the width of a patch.
    EXPECT_LE(fixtures::largest_distance(posed, rig.mesh.V),
              1e-8 * bounding_box_diagonal(rig.mesh.V));
  }
}

TEST(DirectDeltaMush, TurnsWithARigidMotionOfAllJoints) {
  RiggedMesh rig = capsule_finger();
  RandomStream random(11, "bumps");
  for (Eigen::Index v = 0; v < rig.mesh.V.rows(); ++v) {
    for (int k = 0; k < 3; ++k) rig.mesh.V(v, k) += 2e-4 * random.normal();
  }
  const DirectDeltaMush method(rig);
  const Pose pose = fixtures::curled(rig, 0.9);
  Eigen::MatrixX3d still, moved;
  method.deform(pose, still);
  const Eigen::Affine3d motion = Eigen::Translation3d(1, -2, 3) *
                                 Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 1, 2).normalized());
  Pose turned = pose;
  for (Eigen::Affine3d& transform : turned) transform = motion * transform;
  method.deform(turned, moved);
  const Eigen::MatrixX3d expected =
      (still * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  EXPECT_LE(fixtures::largest_distance(moved, expected), 1e-11);
}

TEST(DirectDeltaMush, FollowsASingleBone) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) entries.emplace_back(v, 1, 1.0);
  rig.weights.setFromTriplets(entries.begin(), entries.end());
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.2);
  const Eigen::MatrixX3d posed = fixtures::deformed<DirectDeltaMush>(rig, pose);
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    const Eigen::Vector3d expected = pose[1] * Eigen::Vector3d(rig.mesh.V.row(v));
    EXPECT_LE((posed.row(v).transpose() - expected).norm(), 1e-12) << v;
  }
}

// The tube's symmetries leave the mid-ring's smoothed place on the plane x = 0 with equal shares,
// and its rotation at half the twist.
TEST(DirectDeltaMush, TwistTurnsTheMidRingByHalfTheAngle) {
  const RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const double degrees = 90;
  const Eigen::MatrixX3d posed = fixtures::deformed<DirectDeltaMush>(
      rig, fixtures::turned(rig, "upper", "twist", degrees * kDegree));
  for (const int v : mid_ring(cylinder_options())) {
    const double before = std::atan2(rig.mesh.V(v, 2), rig.mesh.V(v, 1));
    const double after = std::atan2(posed(v, 2), posed(v, 1));
    EXPECT_NEAR(std::remainder(after - before, 2 * std::numbers::pi), degrees / 2 * kDegree, 0.02)
        << v;
  }
}

TEST(DirectDeltaMush, SmoothsTheTearThatRigidWeightsLeave) {
  const RiggedMesh rig = fixtures::torn_cylinder();
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.2);
  const auto longest_edge = [&](const Eigen::MatrixX3d& V) {
    double longest = 0;
    for (Eigen::Index t = 0; t < rig.mesh.F.rows(); ++t) {
      for (int k = 0; k < 3; ++k)
        longest =
            std::max(longest, (V.row(rig.mesh.F(t, k)) - V.row(rig.mesh.F(t, (k + 1) % 3))).norm());
    }
    return longest;
  };
  const double rest = longest_edge(rig.mesh.V);
  const double torn = longest_edge(fixtures::deformed<LinearBlend>(rig, pose)) - rest;
  const double smooth = longest_edge(fixtures::deformed<DirectDeltaMush>(rig, pose)) - rest;
  EXPECT_GT(torn, 0.5 * cylinder_options().radius);
  EXPECT_LE(smooth, 0.25 * torn);
}

// What is given to the strongest joint moves by at most its share times the distance between the
// joints' images, and turns the patch by a like share of the patch's own motion.
TEST(DirectDeltaMush, SmallInfluencesMayBeGivenToTheStrongestJoint) {
  const RiggedMesh rig = capsule_finger();
  const Pose pose = fixtures::curled(rig, 2.0);
  DirectDeltaMushOptions all;
  all.smallest_influence = 0;
  Eigen::MatrixX3d exact, pruned;
  const DirectDeltaMush every(rig, all), some(rig);
  every.deform(pose, exact);
  some.deform(pose, pruned);
  EXPECT_LT(some.influences_per_vertex(), every.influences_per_vertex());
  EXPECT_LE(fixtures::largest_distance(exact, pruned), 2e-4 * FingerOptions{}.radius[0]);
}

TEST(DirectDeltaMush, CollapsedAndIsolatedVerticesStayFinite) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  for (int k = 0; k < 3 * cylinder_options().segments; ++k)
    rig.mesh.V.row(1 + k) = rig.mesh.V.row(0);
  const int segments = cylinder_options().segments;
  rig.mesh.F = Eigen::MatrixX3i(rig.mesh.F.topRows(rig.mesh.F.rows() - segments));
  EXPECT_LE(fixtures::largest_distance(fixtures::deformed<DirectDeltaMush>(rig, rest_pose(2)),
                                       rig.mesh.V),
            1e-8);
  EXPECT_TRUE(
      fixtures::deformed<DirectDeltaMush>(rig, fixtures::turned(rig, "upper", "twist", 3.14))
          .allFinite());
}

TEST(DirectDeltaMush, SameBitsForOneAndTwoThreads) {
  const RiggedMesh rig = capsule_finger();
  const Pose pose = fixtures::curled(rig, 1.3);
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { DirectDeltaMush(rig).deform(pose, one); });
  with_threads(2, [&] { DirectDeltaMush(rig).deform(pose, two); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST(DirectDeltaMush, RefusesWrongInput) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const DirectDeltaMush method(rig);
  Eigen::MatrixX3d posed;
  EXPECT_THROW(method.deform(rest_pose(1), posed), Error);
  Pose pose = rest_pose(2);
  pose[1].translation().x() = std::nan("");
  EXPECT_THROW(method.deform(pose, posed), Error);
  EXPECT_THROW(direct_delta_mush(rig, {}, rest_pose(2)), Error);
  using O = DirectDeltaMushOptions;
  for (const O& bad : {O{.iterations = 0}, O{.lambda = 0}, O{.lambda = std::nan("")},
                       O{.kappa = -1}, O{.kappa = 3.5}, O{.alpha = 1}, O{.alpha = -0.1},
                       O{.smallest_influence = -1}, O{.smallest_influence = 0.5}})
    EXPECT_THROW(DirectDeltaMush(rig, bad), Error);
  RiggedMesh nan = rig;
  nan.mesh.V(5, 1) = std::nan("");
  EXPECT_THROW(DirectDeltaMush{nan}, Error);
  rig.weights *= 0.5;
  EXPECT_THROW(DirectDeltaMush{rig}, Error);
}

}  // namespace
}  // namespace geoprior::skinning
