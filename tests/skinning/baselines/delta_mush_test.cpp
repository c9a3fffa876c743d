#include "baselines/skinning/delta_mush.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <vector>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

using fixtures::cylinder_options;

Eigen::MatrixX3d delta_mush(const RiggedMesh& rig, const Pose& pose,
                            const DeltaMushOptions& options = {}) {
  Eigen::MatrixX3d posed;
  DeltaMush(rig, options).deform(pose, posed);
  return posed;
}

/// Rotation that the header calls R_i: the rotation part of the linear map that takes the rest
/// edges of a ring to the posed ones with the least squares error, in the plane across the ring's
/// rest normal.
Eigen::Matrix3d ring_frame(const std::vector<int>& ring, int i, const Eigen::MatrixX3d& rest,
                           const Eigen::MatrixX3d& posed) {
  Eigen::MatrixX3d before(ring.size(), 3), after(ring.size(), 3);
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    before.row(k) = rest.row(ring[k]) - rest.row(i);
    after.row(k) = posed.row(ring[k]) - posed.row(i);
    const Eigen::Vector3d next = rest.row(ring[(k + 1) % ring.size()]) - rest.row(i);
    area += Eigen::Vector3d(before.row(k)).cross(next);
  }
  const Eigen::Vector3d x = area.unitOrthogonal(), y = area.normalized().cross(x);
  Eigen::MatrixX2d plane(before.rows(), 2);
  plane << before * x, before * y;
  const Eigen::Matrix<double, 2, 3> map = plane.colPivHouseholderQr().solve(after);
  const Eigen::Vector3d a = map.row(0), b = map.row(1);
  const Eigen::Vector3d n = a.cross(b).normalized(), t = (a + b.cross(n)).normalized();
  Eigen::Matrix3d frame;
  frame << t, n.cross(t), n;
  return frame;
}

/// The three lines of the header, s = S(p), d = R^T (p - s), v' = s' + R' d, vertex by vertex.
Eigen::MatrixX3d by_definition(const RiggedMesh& rig, const Pose& pose,
                               const DeltaMushOptions& options) {
  const VertexGraph graph = one_rings(rig.mesh.F, rig.mesh.vertex_count());
  const auto smoothed = [&](Eigen::MatrixX3d V) {
    for (int pass = 0; pass < options.iterations; ++pass) {
      const Eigen::MatrixX3d before = V;
      for (int i = 0; i < V.rows(); ++i) {
        Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
        for (const int j : graph.of(i))
          mean += before.row(j) / static_cast<double>(graph.of(i).size());
        V.row(i) += options.step * (mean - before.row(i));
      }
    }
    return V;
  };
  const Eigen::MatrixX3d s = smoothed(rig.mesh.V), moved = smoothed(linear_blend(rig, pose));
  Eigen::MatrixX3d posed(s.rows(), 3);
  for (int i = 0; i < s.rows(); ++i) {
    const std::vector<int> ring(graph.of(i).begin(), graph.of(i).end());
    const Eigen::Vector3d detail =
        ring_frame(ring, i, s, s).transpose() * (rig.mesh.V.row(i) - s.row(i)).transpose();
    posed.row(i) = moved.row(i) + (ring_frame(ring, i, s, moved) * detail).transpose();
  }
  return posed;
}

/// Sum over the edges of the squared second difference: how far a surface is from smooth.
double roughness(const TriMesh& mesh, const Eigen::MatrixX3d& V) {
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(V.rows(), 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(V.rows());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      sum.row(mesh.F(t, k)) += V.row(mesh.F(t, (k + 1) % 3)) - V.row(mesh.F(t, k));
      count(mesh.F(t, k)) += 1;
    }
  }
  return (sum.array().colwise() / count.array()).matrix().squaredNorm();
}

TEST(DeltaMush, RestPoseReturnsTheInput) {
  // Flat caps have sharp edges: smoothing moves them far, the detail must bring them back.
  CylinderOptions flat = cylinder_options();
  flat.cap_height = 0;
  for (const RiggedMesh& rig : {two_bone_cylinder(flat), capsule_finger()}) {
    for (const int iterations : {0, 1, 20, 200}) {
      DeltaMushOptions options;
      options.iterations = iterations;
      const Eigen::MatrixX3d posed = delta_mush(rig, rest_pose(rig.skeleton.size()), options);
      EXPECT_LE(fixtures::largest_distance(posed, rig.mesh.V),
                1e-13 * bounding_box_diagonal(rig.mesh.V))
          << iterations;
    }
  }
}

TEST(DeltaMush, TurnsWithARigidMotionOfAllJoints) {
  RiggedMesh rig = capsule_finger();
  RandomStream random(11, "bumps");
  for (Eigen::Index v = 0; v < rig.mesh.V.rows(); ++v) {
    for (int k = 0; k < 3; ++k) rig.mesh.V(v, k) += 2e-4 * random.normal();
  }
  Eigen::Affine3d motion = Eigen::Translation3d(1, -2, 3) *
                           Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 1, 2).normalized());
  const Pose pose(4, motion);
  const Eigen::MatrixX3d expected =
      (rig.mesh.V * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  EXPECT_LE(fixtures::largest_distance(delta_mush(rig, pose), expected), 1e-12);
}

TEST(DeltaMush, LanesAgreeWithTheDefinition) {
  const RiggedMesh rig = capsule_finger();
  const Pose pose = fixtures::curled(rig, 0.8);
  const DeltaMushOptions options;
  // The blend's weights are packed as floats.
  EXPECT_LE(
      fixtures::largest_distance(delta_mush(rig, pose, options), by_definition(rig, pose, options)),
      1e-7 * bounding_box_diagonal(rig.mesh.V));
}

TEST(DeltaMush, WithoutIterationsItIsLinearBlend) {
  const RiggedMesh rig = capsule_finger();
  const Pose pose = fixtures::curled(rig, 1.0);
  DeltaMushOptions options;
  options.iterations = 0;
  Eigen::MatrixX3d blended;
  LinearBlend(rig).deform(pose, blended);
  EXPECT_LE(fixtures::largest_distance(delta_mush(rig, pose, options), blended), 1e-15);
}

// Weights of one bone or the other and nothing between leave a tear at the joint; smoothing must
// remove most of its roughness.
TEST(DeltaMush, SmoothsTheTearThatRigidWeightsLeave) {
  const RiggedMesh rig = fixtures::torn_cylinder();
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.2);
  Eigen::MatrixX3d blended;
  LinearBlend(rig).deform(pose, blended);
  const double rest = roughness(rig.mesh, rig.mesh.V);
  const double before = roughness(rig.mesh, blended) - rest;
  const double after = roughness(rig.mesh, delta_mush(rig, pose)) - rest;
  EXPECT_GT(before, 0);
  EXPECT_LE(after, 0.05 * before);
}

TEST(DeltaMush, DetailFollowsTheSurfaceAwayFromTheJoint) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  RandomStream random(2, "bumps");
  for (Eigen::Index v = 0; v < rig.mesh.V.rows(); ++v)
    rig.mesh.V.row(v).tail<2>() *= 1 + 0.05 * random.uniform();
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.2);
  const Eigen::MatrixX3d posed = delta_mush(rig, pose);
  int far = 0;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    // 20 passes and a ring for the frame reach 21 rings of 0.025 m; the ramp ends at 0.1 m. What
    // is left at 0.4 m is the tail of the smoothing kernel.
    if (rig.mesh.V(v, 0) < 0.4) continue;
    ++far;
    const Eigen::Vector3d rigid = pose[1] * Eigen::Vector3d(rig.mesh.V.row(v));
    EXPECT_LE((posed.row(v).transpose() - rigid).norm(), 1e-4 * cylinder_options().radius) << v;
  }
  EXPECT_GT(far, 100);
}

TEST(DeltaMush, BordersCanBePinned) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  const int segments = cylinder_options().segments;
  rig.mesh.F = Eigen::MatrixX3i(rig.mesh.F.bottomRows(rig.mesh.F.rows() - segments));  // no pole
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.0);
  DeltaMushOptions options;
  options.pin_border = true;
  Eigen::MatrixX3d blended;
  LinearBlend(rig).deform(pose, blended);
  const Eigen::MatrixX3d pinned = delta_mush(rig, pose, options);
  for (int v = 0; v <= segments; ++v)  // the pole is isolated now, the first ring is the border
    EXPECT_LE((pinned.row(v) - blended.row(v)).norm(), 1e-14) << v;
}

TEST(DeltaMush, CollapsedVerticesStayFiniteAndChangeNothingElsewhere) {
  const RiggedMesh whole = two_bone_cylinder(cylinder_options());
  RiggedMesh rig = whole;
  // One ring collapses to a point: neighbours at equal positions span no plane.
  for (int k = 0; k < 3 * cylinder_options().segments; ++k)
    rig.mesh.V.row(1 + k) = rig.mesh.V.row(0);
  DeltaMushOptions options;
  options.iterations = 1;
  const Eigen::MatrixX3d rest = delta_mush(rig, rest_pose(2), options);
  EXPECT_LE(fixtures::largest_distance(rest, rig.mesh.V), 1e-12);
  const Pose pose = fixtures::turned(rig, "upper", "twist", 3.14);
  const Eigen::MatrixX3d posed = delta_mush(rig, pose, options);
  EXPECT_TRUE(posed.allFinite());
  // Three rings further on, past the reach of a pass and of the frames.
  const Eigen::Index rest_of_it = rig.mesh.V.rows() - 1 - 6 * cylinder_options().segments;
  EXPECT_LE(fixtures::largest_distance(posed.bottomRows(rest_of_it),
                                       delta_mush(whole, pose, options).bottomRows(rest_of_it)),
            1e-12);
}

TEST(DeltaMush, SameBitsForOneAndTwoThreads) {
  CylinderOptions fine;
  fine.segments = 96;
  const RiggedMesh rig = two_bone_cylinder(fine);
  DeltaMush method(rig, {});
  const Pose pose = fixtures::turned(rig, "upper", "flexion", 1.3);
  Eigen::MatrixX3d one, two;
  with_threads(1, [&] { method.deform(pose, one); });
  with_threads(2, [&] { method.deform(pose, two); });
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST(DeltaMush, RefusesOptionsOutOfRange) {
  const RiggedMesh rig = capsule_finger();
  EXPECT_THROW(DeltaMush(rig, {.iterations = -1}), Error);
  EXPECT_THROW(DeltaMush(rig, {.step = 1.5}), Error);
}

}  // namespace
}  // namespace geoprior::skinning
