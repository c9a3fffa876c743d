#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Singular values of the deformation gradient (rest to posed, in the plane) of each triangle:
/// column 0 the larger, column 1 the smaller; both 1 for an isometry. A triangle degenerate at rest
/// gets 1, 1 and carries no area.
///
/// @param rest,posed  n x 3 (m)
/// @param triangles   rows of F to look at
/// @throws Error      unless `rest` and `posed` have as many rows
Eigen::MatrixX2d singular_values(const Eigen::MatrixX3d& rest, const Eigen::MatrixX3d& posed,
                                 const Eigen::MatrixX3i& F, const std::vector<int>& triangles);

/// Distortion of a piece of surface; quantiles and means weighted by rest area, so that they hardly
/// depend on the tessellation.
struct DistortionSummary {
  double area_ratio_p05 = 1;       ///< 5 % of the area shrink more than this
  double area_ratio_p95 = 1;       ///< 5 % of the area grow more than this
  double area_ratio_max = 1;       ///< largest ratio of a triangle
  double singular_value_max = 1;   ///< largest stretch of a triangle
  double singular_value_min = 1;   ///< strongest compression of a triangle
  double symmetric_dirichlet = 4;  ///< mean of |J|^2 + |J^-1|^2: 4 for an isometry
};

/// Singular values under 1e-6 count as 1e-6 in the symmetric Dirichlet energy, so that a collapsed
/// triangle gives a huge value, not an infinite one.
/// @throws Error  on no triangles, or none with an area
/// Source of the energy: Smith and Schaefer 2015.
DistortionSummary distortion(const Eigen::MatrixX3d& rest, const Eigen::MatrixX3d& posed,
                             const Eigen::MatrixX3i& F, const std::vector<int>& triangles);

}  // namespace geoprior
