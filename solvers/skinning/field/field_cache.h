#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "core/mesh.h"
#include "solvers/skinning/field/bones.h"
#include "solvers/skinning/field/hrbf.h"
#include "solvers/skinning/field/simd.h"

namespace geoprior::skinning {

/// Oriented box around a bone's skin, wide enough that the field is zero outside: the skin's own
/// bounds along the bone and the principal directions across it, and r on every side.
struct FieldBox {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: the box's directions, rest pose
  Eigen::Vector3d low = Eigen::Vector3d::Zero();       ///< corner, in coordinates along `axes` (m)
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
};
FieldBox field_box(const FieldBone& bone, const Eigen::MatrixX3d& V);

/// Cached field of one bone: (grad d, d / r) at the nodes of a grid in the bone's box, trilinear
/// between.
///
/// d is stored and not f, because d is nearly linear: the support function is applied after
/// sampling. The gradient is stored too, since the derivative of a trilinear interpolant jumps
/// between cells. About `grid`^3 nodes in cubic cells, whatever the shape of the box.
class FieldCache {
 public:
  FieldCache(const Hrbf& field, const FieldBox& box, int grid);

  /// @param u  grid coordinates; only those inside (see `extent`) may be asked
  [[nodiscard]] Float4 sample(Float4 u) const {
    const int i = static_cast<int>(u[0]), j = static_cast<int>(u[1]), k = static_cast<int>(u[2]);
    const Float4* c = nodes_.data() + (k * stride_k_ + j * stride_j_ + i);
    const Float4 x = splat(u[0] - static_cast<float>(i));
    const Float4 y = splat(u[1] - static_cast<float>(j));
    const Float4 z = splat(u[2] - static_cast<float>(k));
    const Float4* d = c + stride_k_;
    const Float4 c0 = c[0] + x * (c[1] - c[0]);
    const Float4 c1 = c[stride_j_] + x * (c[stride_j_ + 1] - c[stride_j_]);
    const Float4 d0 = d[0] + x * (d[1] - d[0]);
    const Float4 d1 = d[stride_j_] + x * (d[stride_j_ + 1] - d[stride_j_]);
    const Float4 near = c0 + y * (c1 - c0);
    const Float4 far = d0 + y * (d1 - d0);
    return near + z * (far - near);
  }
  /// Largest grid coordinates: 0 <= u < extent.
  [[nodiscard]] Eigen::Vector3d extent() const { return extent_; }
  [[nodiscard]] double cell_size() const { return cell_; }
  [[nodiscard]] std::array<int, 3> size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return nodes_.size() * sizeof(Float4); }

 private:
  std::vector<Float4> nodes_;
  std::array<int, 3> size_{};
  int stride_j_ = 0;
  int stride_k_ = 0;
  Eigen::Vector3d extent_ = Eigen::Vector3d::Zero();
  double cell_ = 0;  // metres
};

}  // namespace geoprior::skinning
