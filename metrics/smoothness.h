#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace geoprior {

/// Whether neighbouring parameters are equally far apart, within 1e-9 of the step; true for fewer
/// than three.
bool equally_spaced(std::span<const double> parameters);

/// Largest second difference |x_{i+1} - 2 x_i + x_{i-1}| of a vertex position over a sweep of equal
/// steps (m).
///
/// A pop of size J shows as about J whatever the step, while smooth motion falls as step^2. Rigid
/// motion counts too (radius * step^2 for a rotation): give positions in the frame of the bone to
/// leave it out.
///
/// @param positions   one n x 3 matrix a frame, in order of parameter
/// @param parameters  of the frames
/// @param vertices    rows to look at; empty: all
/// @return            0 for fewer than three frames
/// @throws Error      when the parameters are not equally spaced or the sizes differ
double second_difference_max(const std::vector<Eigen::MatrixX3d>& positions,
                             std::span<const double> parameters,
                             const std::vector<int>& vertices = {});

}  // namespace geoprior
