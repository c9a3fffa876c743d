#pragma once

#include <Eigen/Core>

namespace geoprior {

/// What the triangulation of a flat pattern is like.
struct PatternMeshSummary {
  double area = 0;          ///< sum of the signed areas (m^2): that of the pattern when it is
                            ///< covered once
  double min_altitude = 0;  ///< smallest height of a triangle over its longest edge (m); negative
                            ///< for one turned over
  double min_area = 0;      ///< smallest signed area of a triangle (m^2)
  int inverted = 0;         ///< triangles that are turned over or have no area
};

/// @param pattern    n x 2 (m)
/// @param triangles  m x 3, counter-clockwise where they are not turned over
/// @throws Error     on no triangles
PatternMeshSummary pattern_mesh(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles);

}  // namespace geoprior
