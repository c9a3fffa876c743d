#include "solvers/skinning/field/field_cache.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <string>

#include "core/limits.h"
#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

/// Directions of a bone: principal directions of its skin across the bone, and the bone itself.
Eigen::Matrix3d box_axes(const FieldBone& bone, const Eigen::MatrixX3d& V) {
  Eigen::Vector3d along = bone.tail - bone.head;
  const bool has_direction = along.norm() > 0;
  if (has_direction) along.normalize();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int v : bone.vertices) mean += V.row(v).transpose();
  mean /= static_cast<double>(bone.vertices.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const int v : bone.vertices) {
    Eigen::Vector3d d = V.row(v).transpose() - mean;
    if (has_direction) d -= d.dot(along) * along;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(covariance);
  Eigen::Matrix3d axes;
  Eigen::Vector3d widest = principal.eigenvectors().col(2);
  if (!has_direction) along = principal.eigenvectors().col(0);
  widest = (widest - widest.dot(along) * along).normalized();
  axes.col(0) = widest;
  axes.col(1) = along.cross(widest);
  axes.col(2) = along;
  return axes;
}

/// Of a box that is longer than wide there are more than `grid`^3; they are numbered with 32 bits.
void require_nodes(double nodes) {
  const std::string what = "nodes of a bone's field";
  require_memory(nodes * sizeof(Float4), nodes, what, "options.grid");
  require_count(nodes, what, std::numeric_limits<int>::max(), "options.grid");
}

}  // namespace

FieldBox field_box(const FieldBone& bone, const Eigen::MatrixX3d& V) {
  FieldBox box;
  box.axes = box_axes(bone, V);
  box.low = box.axes.transpose() * bone.head;
  box.high = box.low;
  const auto include = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = box.axes.transpose() * p;
    box.low = box.low.cwiseMin(q);
    box.high = box.high.cwiseMax(q);
  };
  include(bone.tail);
  for (const int v : bone.vertices) include(V.row(v).transpose());
  box.low.array() -= bone.radius;
  box.high.array() += bone.radius;
  return box;
}

FieldCache::FieldCache(const Hrbf& field, const FieldBox& box, int grid) {
  const Eigen::Vector3d size = box.high - box.low;
  cell_ = std::cbrt(size.prod()) / std::max(1, grid - 1);
  extent_ = (size.array() / cell_ - 1e-9).ceil().max(1);
  require_nodes((extent_.array() + 1).prod());
  for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(extent_(k)) + 1;
  stride_j_ = size_[0];
  stride_k_ = size_[0] * size_[1];
  nodes_.resize(static_cast<std::size_t>(stride_k_) * size_[2]);
  const auto rows = static_cast<std::size_t>(size_[1]) * size_[2];
  parallel_blocks(rows, 32, [&](std::size_t begin, std::size_t end) {
    Eigen::MatrixX3d points(size_[0], 3);
    Eigen::MatrixX4d values;
    for (std::size_t row = begin; row < end; ++row) {
      const int j = static_cast<int>(row) % size_[1], k = static_cast<int>(row) / size_[1];
      for (int i = 0; i < size_[0]; ++i) {
        const Eigen::Vector3d q = box.low + cell_ * Eigen::Vector3d(i, j, k);
        points.row(i) = (box.axes * q).transpose();
      }
      field.evaluate(points, values);
      for (int i = 0; i < size_[0]; ++i) {
        const Eigen::RowVector4f v = values.row(i).cast<float>();
        nodes_[row * size_[0] + static_cast<std::size_t>(i)] = Float4{v(0), v(1), v(2), v(3)};
      }
    }
  });
}

}  // namespace geoprior::skinning
