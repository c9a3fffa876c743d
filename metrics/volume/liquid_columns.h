#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Upright lines at the centres of a grid of squares, x fastest: what a wave gauge sees. Probes do
/// not move, so that surfaces without any correspondence can be compared.
struct ColumnGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower corner (m)
  double spacing = 1;                                ///< m
  int nx = 1, ny = 1;

  [[nodiscard]] Eigen::Vector2d probe(int i, int j) const {
    return origin + spacing * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  [[nodiscard]] Eigen::Index index(int i, int j) const { return i + Eigen::Index{nx} * j; }
  [[nodiscard]] Eigen::Index count() const { return Eigen::Index{nx} * ny; }
};

/// Grid of squares of about `spacing` that covers the box of the points in x and y.
ColumnGrid covering_grid(const Eigen::MatrixX3d& points, double spacing);

/// Where the line of column (i, j) passes through a triangle.
struct ColumnCrossing {
  int i, j;
  double height;  ///< m
  int sign;       ///< +1: the triangle is seen from above, what it encloses lies below; -1: above
};

/// Appends the crossings of a triangle with the columns of some rows of the grid. Over the
/// triangles of a closed surface each crossing comes exactly once, also on edges and vertices
/// (a consistent rule for ties).
/// @param corners  rows: the triangle's corners, finite
void append_crossings(const Eigen::Matrix3d& corners, const ColumnGrid& grid, int first_row,
                      int last_row, std::vector<ColumnCrossing>* crossings);

/// What the lines meet.
struct Columns {
  Eigen::VectorXd top;  ///< highest crossing (m); NaN where the line meets nothing
  Eigen::VectorXd
      depth;  ///< length inside a closed, outward oriented surface (m); else meaningless
};

/// Each crossing of a line with a closed surface counts exactly once (`append_crossings`).
/// @throws Error  on a coordinate that is not finite
Columns columns(const TriMesh& mesh, const ColumnGrid& grid);

/// Two rows of column tops (or depths), where both have a value.
struct ColumnComparison {
  int probes = 0;           ///< that have a value in both
  double rms = 0, max = 0;  ///< of the difference (m)
  double correlation =
      1;  ///< Pearson's; 1 when both are constant and equal, 0 when one is constant
};
/// @throws Error  unless both have as many entries
ColumnComparison compare_columns(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Largest |h(t+1) - 2 h(t) + h(t-1)| over probes that have all three values (m); 0 without any.
double largest_second_difference(const Eigen::VectorXd& before, const Eigen::VectorXd& now,
                                 const Eigen::VectorXd& after);

}  // namespace geoprior
