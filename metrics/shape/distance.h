#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// Distances between corresponding vertices of two states of one mesh (m).
struct VertexDistance {
  double rms = 0;
  double max = 0;
};

/// @param vertices  rows to look at; empty: all
/// @throws Error    unless both have as many rows, at least one
VertexDistance vertex_distance(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b,
                               const std::vector<int>& vertices = {});

}  // namespace geoprior
