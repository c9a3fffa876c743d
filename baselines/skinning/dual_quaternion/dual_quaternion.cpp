#include "baselines/skinning/dual_quaternion/dual_quaternion.h"

#include <Eigen/Geometry>

#include "baselines/skinning/dual_quaternion/lanes.h"
#include "baselines/skinning/shared/rigid_joints.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

struct DualQuaternion {
  Eigen::Quaterniond real, dual;
};

/// Unit dual quaternion r + eps t r / 2 of the rigid part x -> r x r* + t of a joint's transform.
DualQuaternion dual_quaternion(const Eigen::Affine3d& transform, const Eigen::Vector3d& head) {
  const Eigen::Matrix3d R = rotation_of(transform);
  const Eigen::Vector3d t = transform * head - R * head;
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  return {q, Eigen::Quaterniond(0, 0.5 * t.x(), 0.5 * t.y(), 0.5 * t.z()) * q};
}

/// b = sum_j w_j s_j q_j of one vertex.
DualQuaternion blend(const std::vector<DualQuaternion>& q, const SkinWeights& weights, int vertex) {
  SkinWeights::InnerIterator pivot(weights, vertex);
  for (SkinWeights::InnerIterator w(weights, vertex); w; ++w)
    if (w.value() > pivot.value()) pivot = w;
  DualQuaternion b{{0, 0, 0, 0}, {0, 0, 0, 0}};
  for (SkinWeights::InnerIterator w(weights, vertex); w; ++w) {
    const double sign = q[w.col()].real.dot(q[pivot.col()].real) < 0 ? -1 : 1;
    b.real.coeffs() += w.value() * sign * q[w.col()].real.coeffs();
    b.dual.coeffs() += w.value() * sign * q[w.col()].dual.coeffs();
  }
  return b;
}

}  // namespace

Eigen::MatrixX3d dual_quaternion_blend(const RiggedMesh& rig, const Pose& pose) {
  require_finite_pose(pose, rig.skeleton.size(), "dual quaternion blend");
  std::vector<DualQuaternion> q;
  for (std::size_t j = 0; j < pose.size(); ++j)
    q.push_back(dual_quaternion(pose[j], rig.skeleton.joints[j].head));
  Eigen::MatrixX3d posed(rig.mesh.vertex_count(), 3);
  for (int i = 0; i < rig.mesh.vertex_count(); ++i) {
    const Eigen::Vector3d v = rig.mesh.V.row(i);
    const auto [r, e] = blend(q, rig.weights, i);
    posed.row(i) =
        r.normalized() * v + 2 / r.squaredNorm() * (e * r.conjugate()).vec();  // turned, then moved
  }
  return posed;
}

DualQuaternionBlend::DualQuaternionBlend(const RiggedMesh& rig) : influences_(rig) {
  for (const Joint& joint : rig.skeleton.joints) heads_.push_back(joint.head);
}

void DualQuaternionBlend::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  require_finite_pose(pose, influences_.joint_count, "dual quaternion blend");
  lanes::JointTable<lanes::DualQuaternion> table(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const auto [q, d] = dual_quaternion(pose[j], heads_[j]);
    table[j] = {{q.x(), q.y(), q.z(), q.w()}, {d.x(), d.y(), d.z(), d.w()}};
  }
  const auto kernel = [q = table.data()](const lanes::Block& block, lanes::Double4& x,
                                         lanes::Double4& y, lanes::Double4& z) {
    lanes::Four real, dual;
    lanes::blend(q, block, real, dual);
    lanes::transform(real, dual, block.rest, x, y, z);
  };
  lanes::for_all_chunks(influences_, posed, kernel);
}

}  // namespace geoprior::skinning
