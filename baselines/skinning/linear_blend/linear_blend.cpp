#include "baselines/skinning/linear_blend/linear_blend.h"

#include <string>

#include "baselines/skinning/linear_blend/lanes.h"
#include "core/error.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

void require_one_transform_a_joint(const Pose& pose, int joints) {
  if (std::ssize(pose) == joints) return;
  throw Error("pose of " + std::to_string(pose.size()) + " transforms", "linear blend",
              std::to_string(joints));
}

}  // namespace

Eigen::MatrixX3d linear_blend(const RiggedMesh& rig, const Pose& pose) {
  require_one_transform_a_joint(pose, rig.skeleton.size());
  Eigen::MatrixX3d posed = Eigen::MatrixX3d::Zero(rig.mesh.vertex_count(), 3);
  for (int i = 0; i < rig.mesh.vertex_count(); ++i) {
    const Eigen::Vector3d v = rig.mesh.V.row(i);
    for (SkinWeights::InnerIterator w(rig.weights, i); w; ++w)
      posed.row(i) += w.value() * (pose[w.col()] * v).transpose();
  }
  return posed;
}

LinearBlend::LinearBlend(const RiggedMesh& rig) : influences_(rig) {}

void LinearBlend::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  require_one_transform_a_joint(pose, influences_.joint_count);
  lanes::JointTable<lanes::MatrixRows> table(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j)
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(table[j].row.data()) =
        pose[j].matrix().topRows<3>();
  const auto kernel = [T = table.data()](const lanes::Block& block, lanes::Double4& x,
                                         lanes::Double4& y, lanes::Double4& z) {
    lanes::blend_block(T, block, x, y, z);
  };
  lanes::for_all_chunks(influences_, posed, kernel);
}

}  // namespace geoprior::skinning
