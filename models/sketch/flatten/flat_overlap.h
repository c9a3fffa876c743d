#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace geoprior::sketch {

/// Pairs of triangles of a flat piece that cover a common area: places where the piece could not be
/// cut from one sheet.
///
/// Two triangles overlap when they cannot be parted by moving one of them by `depth`: the two sides
/// of a closed dart, which coincide but for round-off, do not. Triangles that are turned over
/// overlap with their neighbours. Linear in the number of triangles for triangles of similar size
/// (a grid of their boxes).
///
/// @param points     n x 2 (m)
/// @param triangles  m x 3, of either direction
/// @param depth      not negative (m)
/// @return           pairs, the lower one first, ascending
std::vector<std::array<int, 2>> overlapping_triangles(const Eigen::MatrixX2d& points,
                                                      const Eigen::MatrixX3i& triangles,
                                                      double depth);

}  // namespace geoprior::sketch
