#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::torus {

/// n x n points of a torus, x, y, z apart: point (i, j) is that of parameter (i / n, j / n).
struct GridSurface {
  int n = 0;
  std::array<Eigen::ArrayXXd, 3> x;  ///< column j, row i
};

/// The bicubic spline through the points of a grid, periodic: twice continuously differentiable.
class SplineSurface {
 public:
  /// @param surface  of at least 8 x 8 points
  explicit SplineSurface(const GridSurface& surface);

  struct Point {
    Eigen::Vector3d value, along_x, along_y;
  };
  [[nodiscard]] Point at(const Eigen::Vector2d& parameter) const;

 private:
  int n_;
  std::vector<Eigen::Vector4d> coefficients_;  ///< x, y, z, 0 of (i, j), i fastest
};

}  // namespace geoprior::torus
