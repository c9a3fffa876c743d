#include "baselines/skinning/direct_delta_mush/direct_delta_mush.h"

#include <Eigen/SVD>
#include <algorithm>
#include <string>

#include "baselines/skinning/direct_delta_mush/lanes.h"
#include "baselines/skinning/shared/rigid_joints.h"
#include "core/error.h"
#include "core/parallel.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

constexpr const char* kDirectDeltaMush = "direct delta mush";

/// Vertices of a block, and blocks of a task.
constexpr int kFour = 4;
constexpr std::size_t kBlocksOfATask = 32;

/// The rotation that maximises tr(R' S).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& S) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(S, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

Eigen::MatrixX3d direct_delta_mush(const RiggedMesh& rig, const DirectDeltaMushMatrices& matrices,
                                   const Pose& pose) {
  require_finite_pose(pose, rig.skeleton.size(), kDirectDeltaMush);
  if (matrices.smoothed.rows() != rig.mesh.vertex_count())
    throw Error("matrices of " + std::to_string(matrices.smoothed.rows()) + " vertices",
                kDirectDeltaMush, std::to_string(rig.mesh.vertex_count()));
  Eigen::MatrixX3d posed(rig.mesh.vertex_count(), 3);
  for (Eigen::Index i = 0; i < posed.rows(); ++i) {
    const Eigen::Vector3d p = matrices.smoothed.row(i);
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    Eigen::Vector3d q = Eigen::Vector3d::Zero();
    const std::size_t vertex = i;
    for (std::size_t e = matrices.offset[vertex]; e < matrices.offset[vertex + 1]; ++e) {
      const JointMatrix& omega = matrices.matrices[e];
      const Eigen::Affine3d& M = pose[omega.joint];
      S += M.linear() * omega.shape + (M * p) * omega.offset.transpose();
      q += M.linear() * omega.offset + omega.share * (M * p);
    }
    posed.row(i) = q + nearest_rotation(S) * (rig.mesh.V.row(i).transpose() - p);
  }
  return posed;
}

DirectDeltaMush::DirectDeltaMush(const RiggedMesh& rig, const DirectDeltaMushOptions& options)
    : vertex_count_(rig.mesh.vertex_count()), joint_count_(rig.skeleton.size()) {
  const DirectDeltaMushMatrices matrices = direct_delta_mush_matrices(rig, options);
  for (int first = 0; first < vertex_count_; first += kFour) {
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < kFour; ++l) {
        const int v = std::min(first + l, vertex_count_ - 1);
        smoothed_.push_back(matrices.smoothed(v, k));
        detail_.push_back(rig.mesh.V(v, k) - matrices.smoothed(v, k));
      }
    }
  }
  offset_.assign(matrices.offset.begin(), matrices.offset.end());
  for (const JointMatrix& omega : matrices.matrices) {
    joints_.push_back(static_cast<std::uint16_t>(omega.joint));
    Eigen::Matrix4d whole;
    whole << omega.shape, omega.offset, omega.offset.transpose(), omega.share;
    PackedMatrix& packed = matrices_.emplace_back();
    Eigen::Map<Eigen::Matrix4f>(packed.row.data()) = whole.cast<float>();  // symmetric
  }
}

double DirectDeltaMush::influences_per_vertex() const {
  return vertex_count_ > 0 ? static_cast<double>(matrices_.size()) / vertex_count_ : 0;
}

void DirectDeltaMush::deform(const Pose& pose, Eigen::MatrixX3d& posed) const {
  require_finite_pose(pose, joint_count_, kDirectDeltaMush);
  lanes::JointTable<lanes::MatrixRows> table(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j)
    Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(table[j].row.data()) =
        pose[j].matrix().topRows<3>();
  posed.resize(vertex_count_, 3);
  const auto patch_of = [&, transforms = table.data()](std::size_t block, std::size_t lane) {
    const auto last = static_cast<std::size_t>(vertex_count_) - 1;
    const std::size_t v = std::min(kFour * block + lane, last);
    const double* p = smoothed_.data() + 12 * block + lane;
    return lanes::moved_patch(
        transforms, joints_.data() + offset_[v],
        std::span<const PackedMatrix>(matrices_).subspan(offset_[v], offset_[v + 1] - offset_[v]),
        {lanes::all(p[0]), lanes::all(p[4]), lanes::all(p[8])});
  };
  const std::size_t blocks = smoothed_.size() / 12;
  parallel_blocks(blocks, kBlocksOfATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      std::array<lanes::BlendedRows, 4> patch{patch_of(b, 0), patch_of(b, 1), patch_of(b, 2),
                                              patch_of(b, 3)};
      lanes::Double4 position[3];
      lanes::place(patch, detail_.data() + 12 * b, position[0], position[1], position[2]);
      const Eigen::Index first = kFour * b;
      const Eigen::Index count = std::min<Eigen::Index>(kFour, vertex_count_ - first);
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < count; ++l) posed(first + l, k) = position[k][l];
      }
    }
  });
}

}  // namespace geoprior::skinning
