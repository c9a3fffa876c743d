#pragma once

#include <array>
#include <vector>

#include "models/paper/shell/state.h"

namespace geoprior::paper {

/// Finds triangles of a triangulated pattern by point: built once, asked often.
class PatternLocator {
 public:
  explicit PatternLocator(const ShellMesh& mesh);
  struct Place {
    int triangle = -1;
    Eigen::Vector3d weights;  ///< barycentric
  };
  /// The triangle that contains `p`, or the nearest one (weights then clamped to it).
  /// @param guess  looked at first, for points that come in order: the result is the same
  [[nodiscard]] Place locate(const Eigen::Vector2d& p, int guess = -1) const;
  /// The triangle at the end of the straight way from a point of the mesh to `p`, or where a border
  /// stops it: on a cut, the lip on that side. Weights of a point beyond are negative.
  /// @param guess  looked at first for `from`
  [[nodiscard]] Place locate(const Eigen::Vector2d& p, const Eigen::Vector2d& from,
                             int guess = -1) const;

 private:
  [[nodiscard]] Eigen::Vector3d barycentric(int triangle, const Eigen::Vector2d& p) const;
  [[nodiscard]] Place nearest(const Eigen::Vector2d& p) const;
  [[nodiscard]] int column(double u) const;
  [[nodiscard]] int row(double v) const;

  Eigen::MatrixX2d pattern_;
  Eigen::MatrixX3i triangles_;
  Eigen::Vector2d origin_;
  double cell_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<int> offset_, items_;  ///< triangles whose boxes meet each cell of a grid
  mutable std::vector<std::array<int, 3>> across_;  ///< of each triangle, once asked for
};

}  // namespace geoprior::paper
