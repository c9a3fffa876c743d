#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// A flat pattern seen through a regular grid: which triangle lies at each grid point. Measures on
/// the grid compare meshes of one pattern that have nothing else in common.
///
/// Grid points stand off the corner of the pattern's bounding box by irrational fractions of the
/// spacing, so that they avoid regular meshes and the folds of round patterns. A point on an edge
/// belongs to exactly one of its triangles.
struct PatternGrid {
  Eigen::Vector2d origin{0, 0};  ///< point (0, 0)
  double spacing = 0;            ///< m
  int columns = 0, rows = 0;
  std::vector<int> triangle;  ///< at point (i, j), entry j * columns + i; -1 outside

  [[nodiscard]] Eigen::Vector2d point(int i, int j) const {
    return origin + spacing * Eigen::Vector2d(i, j);
  }
  /// -1 outside the pattern and beyond the grid.
  [[nodiscard]] int at(int i, int j) const {
    if (i < 0 || j < 0 || i >= columns || j >= rows) return -1;
    return triangle[static_cast<std::size_t>(j) * columns + i];
  }
};

/// @param pattern    n x 2 (m)
/// @param triangles  m x 3, either orientation; where they overlap the later one counts
/// @param spacing    m; the grid may have at most 2^24 points
/// @throws Error     on a spacing that is not positive or too small, or no triangles
PatternGrid pattern_grid(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles,
                         double spacing);

}  // namespace geoprior
