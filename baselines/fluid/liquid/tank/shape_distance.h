#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>

#include "baselines/fluid/liquid/tank/liquid_shape.h"

namespace geoprior::fluid {

/// Signed distance of a shape (m), negative inside. For a mesh: exact within a few cells of the
/// surface on the grid it was made for; built once. @throws Error  for a mesh that is not closed
class ShapeDistance {
 public:
  explicit ShapeDistance(const LiquidShape& shape, double cell);
  ~ShapeDistance();
  ShapeDistance(ShapeDistance&&) noexcept;
  ShapeDistance& operator=(ShapeDistance&&) noexcept;
  /// @param x  in the frame in which the shape was given (the caller undoes a motion)
  [[nodiscard]] double operator()(const Eigen::Vector3d& x) const;
  [[nodiscard]] Eigen::AlignedBox3d bounds() const;  ///< of the body, infinite for a half space

 private:
  struct Grid;
  LiquidShape shape_;
  std::unique_ptr<Grid> grid_;
};

}  // namespace geoprior::fluid
