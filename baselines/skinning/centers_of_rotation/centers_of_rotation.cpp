#include "baselines/skinning/centers_of_rotation/centers_of_rotation.h"

#include <Eigen/Geometry>
#include <string>
#include <utility>

#include "baselines/skinning/centers_of_rotation/lanes.h"
#include "baselines/skinning/shared/rigid_joints.h"
#include "core/error.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

constexpr const char* kCentersOfRotation = "centers of rotation";

/// sum_j w_j s_j q_j of one vertex, made unit.
Eigen::Quaterniond blended_rotation(const std::vector<Eigen::Quaterniond>& q,
                                    const SkinWeights& weights, int vertex) {
  SkinWeights::InnerIterator pivot(weights, vertex);
  for (SkinWeights::InnerIterator w(weights, vertex); w; ++w)
    if (w.value() > pivot.value()) pivot = w;
  Eigen::Quaterniond sum(0, 0, 0, 0);
  for (SkinWeights::InnerIterator w(weights, vertex); w; ++w) {
    const double sign = q[w.col()].dot(q[pivot.col()]) < 0 ? -1 : 1;
    sum.coeffs() += w.value() * sign * q[w.col()].coeffs();
  }
  return sum.normalized();
}

/// The rig with its centers of rotation in place of the vertices.
RiggedMesh moved_to(const RiggedMesh& rig, const Eigen::MatrixX3d& centers) {
  RiggedMesh moved = rig;
  moved.mesh.V = centers;
  return moved;
}

}  // namespace

Eigen::MatrixX3d blend_about_centers(const RiggedMesh& rig, const Eigen::MatrixX3d& centers,
                                     const Pose& pose) {
  require_finite_pose(pose, rig.skeleton.size(), kCentersOfRotation);
  if (centers.rows() != rig.mesh.vertex_count())
    throw Error(std::to_string(centers.rows()) + " centers of rotation", kCentersOfRotation,
                std::to_string(rig.mesh.vertex_count()));
  std::vector<Eigen::Quaterniond> q;
  for (const Eigen::Affine3d& transform : pose)
    q.emplace_back(Eigen::Quaterniond(rotation_of(transform)).normalized());
  Eigen::MatrixX3d posed(rig.mesh.vertex_count(), 3);
  for (int i = 0; i < rig.mesh.vertex_count(); ++i) {
    const Eigen::Vector3d center = centers.row(i);
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    for (SkinWeights::InnerIterator w(rig.weights, i); w; ++w)
      moved += w.value() * (pose[w.col()] * center);
    const Eigen::Vector3d arm = rig.mesh.V.row(i).transpose() - center;
    posed.row(i) = moved + blended_rotation(q, rig.weights, i) * arm;
  }
  return posed;
}

CentersOfRotation::CentersOfRotation(const RiggedMesh& rig, const CentersOfRotationOptions& options)
    : centers_(centers_of_rotation(rig, options)), influences_(moved_to(rig, centers_)) {
  arms_ = PackedInfluences(rig).rest;
  for (std::size_t i = 0; i < arms_.size(); ++i) arms_[i] -= influences_.rest[i];
}

void CentersOfRotation::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  require_finite_pose(pose, influences_.joint_count, kCentersOfRotation);
  lanes::JointTable<lanes::TurningJoint> table(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) {
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(table[j].row.data()) =
        pose[j].matrix().topRows<3>();
    Eigen::Map<Eigen::Vector4d>(table[j].real.data()) =
        Eigen::Quaterniond(rotation_of(pose[j])).normalized().coeffs();
  }
  const auto kernel = [joints = table.data(), arms = arms_.data(), rest = influences_.rest.data()](
                          const lanes::Block& block, lanes::Double4& x, lanes::Double4& y,
                          lanes::Double4& z) {
    lanes::blend_block(joints, block, x, y, z);
    lanes::add_turned(lanes::blend_rotations(joints, block), arms + (block.rest - rest), x, y, z);
  };
  lanes::for_all_chunks(influences_, posed, kernel);
}

}  // namespace geoprior::skinning
