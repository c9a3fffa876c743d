#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace geoprior::paper {

/// The triangle across each edge, from corner k to corner k + 1, of each triangle; -1 at the
/// border. Linear in the size of the mesh.
/// @throws Error  on an edge with more than two triangles, or two that run the same way along it
std::vector<std::array<int, 3>> triangle_neighbours(const Eigen::MatrixX3i& triangles,
                                                    int vertex_count);

}  // namespace geoprior::paper
