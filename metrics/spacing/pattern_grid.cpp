#include "metrics/spacing/pattern_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior {
namespace {

constexpr double kMostPoints = 1 << 24;
const Eigen::Vector2d kStandOff(0.381966011250105, 0.414213562373095);  // of a spacing

/// Where the edge meets the height `v`. Computed from its lower vertex index to the higher, so that
/// both triangles at the edge get the same number and share no grid point.
double crossing(const Eigen::MatrixX2d& pattern, int a, int b, double v) {
  if (a > b) std::swap(a, b);
  const double t = (v - pattern(a, 1)) / (pattern(b, 1) - pattern(a, 1));
  return pattern(a, 0) + t * (pattern(b, 0) - pattern(a, 0));
}

/// Column of the first grid point at or right of `u`.
int first_column(const PatternGrid& grid, double u) {
  const double column = std::ceil((u - grid.origin(0)) / grid.spacing);
  return static_cast<int>(std::clamp(column, 0.0, static_cast<double>(grid.columns)));
}

void fill(const Eigen::MatrixX2d& pattern, const Eigen::RowVector3i& corners, int triangle,
          PatternGrid& grid) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int k = 0; k < 3; ++k) {
    low = std::min(low, pattern(corners(k), 1));
    high = std::max(high, pattern(corners(k), 1));
  }
  const auto row_of = [&](double v) {
    const double row = std::ceil((v - grid.origin(1)) / grid.spacing);
    return static_cast<int>(std::clamp(row, 0.0, static_cast<double>(grid.rows)));
  };
  for (int j = row_of(low); j < row_of(high); ++j) {
    const double v = grid.point(0, j)(1);
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (int k = 0; k < 3; ++k) {
      const int a = corners(k);
      const int b = corners((k + 1) % 3);
      if ((pattern(a, 1) <= v) == (pattern(b, 1) <= v)) continue;
      const double u = crossing(pattern, a, b, v);
      left = std::min(left, u);
      right = std::max(right, u);
    }
    if (!(left < right)) continue;
    const auto row = grid.triangle.begin() + static_cast<std::ptrdiff_t>(j) * grid.columns;
    std::fill(row + first_column(grid, left), row + first_column(grid, right), triangle);
  }
}

}  // namespace

PatternGrid pattern_grid(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles,
                         double spacing) {
  if (triangles.rows() == 0) throw Error("no triangles", "pattern grid", "at least one");
  if (!(spacing > 0)) throw Error("spacing is not positive", "pattern grid", "above 0 m");
  const Eigen::Vector2d low = pattern.colwise().minCoeff().transpose();
  const Eigen::Vector2d extent = pattern.colwise().maxCoeff().transpose() - low;
  const Eigen::Vector2d steps = ((extent / spacing - kStandOff).array().floor() + 1).max(1);
  if (!(steps(0) * steps(1) <= kMostPoints)) {
    throw Error("spacing of " + std::to_string(spacing) + " m gives too many points",
                "pattern grid", "at most 2^24 points");
  }
  PatternGrid grid;
  grid.origin = low + spacing * kStandOff;
  grid.spacing = spacing;
  grid.columns = static_cast<int>(steps(0));
  grid.rows = static_cast<int>(steps(1));
  grid.triangle.assign(static_cast<std::size_t>(grid.columns) * grid.rows, -1);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    fill(pattern, triangles.row(t), static_cast<int>(t), grid);
  }
  return grid;
}

}  // namespace geoprior
