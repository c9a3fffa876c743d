#pragma once

#include <Eigen/Core>

namespace geoprior {

/// How far a sheet is from an isometric image of its flat pattern.
struct IsometrySummary {
  double rms = 0;  ///< of |sigma - 1|, both singular values of each triangle, by pattern area
  double max = 0;  ///< largest |sigma - 1|
  double edge_error_p95 = 0;  ///< relative change of length that 95 % of the edges (by their length
                              ///< in the pattern) stay under
  double edge_error_max = 0;  ///< of any edge
  double area_drift = 0;      ///< area in space over area of the pattern, minus 1
};

/// The map from the pattern to space is linear on each triangle; its singular values sigma are both
/// 1 where it is an isometry.
///
/// Says how much the mesh stretches, not how well the mesh follows a smooth surface: a coarse
/// polyhedron can be a perfect isometry. Accurate to 1e-8 (the singular values of an isometry are
/// equal, so their difference is a root of round-off). Triangles without area in the pattern carry
/// no weight.
///
/// @param pattern    n x 2 (m)
/// @param x          n x 3 (m)
/// @param triangles  m x 3, vertex indices
/// @throws Error     unless `pattern` and `x` have as many rows; when no triangle has an area
IsometrySummary isometry(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                         const Eigen::MatrixX3i& triangles);

}  // namespace geoprior
