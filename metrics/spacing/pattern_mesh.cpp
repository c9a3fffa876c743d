#include "metrics/spacing/pattern_mesh.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace geoprior {

PatternMeshSummary pattern_mesh(const Eigen::MatrixX2d& pattern,
                                const Eigen::MatrixX3i& triangles) {
  if (triangles.rows() == 0) throw Error("no triangles", "pattern mesh", "at least one");
  PatternMeshSummary summary;
  summary.min_altitude = std::numeric_limits<double>::infinity();
  summary.min_area = std::numeric_limits<double>::infinity();
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector2d a = pattern.row(triangles(t, 0));
    const Eigen::RowVector2d u = pattern.row(triangles(t, 1)) - a;
    const Eigen::RowVector2d v = pattern.row(triangles(t, 2)) - a;
    const double area = (u(0) * v(1) - u(1) * v(0)) / 2;
    const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
    summary.area += area;
    summary.min_area = std::min(summary.min_area, area);
    summary.min_altitude = std::min(summary.min_altitude, longest > 0 ? 2 * area / longest : 0.0);
    if (!(area > 0)) ++summary.inverted;
  }
  return summary;
}

}  // namespace geoprior
