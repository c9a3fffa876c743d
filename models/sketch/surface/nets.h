#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace geoprior::sketch {

/// Values of a function at the points of a regular grid, x fastest; negative inside.
struct GridFunction {
  std::array<int, 3> size{0, 0, 0};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double spacing = 1;  ///< m
  std::vector<double> values;

  [[nodiscard]] int index(int i, int j, int k) const { return (k * size[1] + j) * size[0] + i; }
};

/// A closed surface of quadrilaterals, counter-clockwise seen from outside.
struct QuadMesh {
  Eigen::MatrixX3d V;
  std::vector<std::array<int, 4>> quads;
  /// Of each vertex: where its sheet crosses the edges of the cell; their mean is the vertex.
  std::vector<std::vector<Eigen::Vector3d>> crossings;
};

/// The zero surface of the function: one vertex for every sheet of it in a cell, at the mean of the
/// sheet's crossings with the cell's edges; one quadrilateral for every edge of the grid that it
/// crosses.
///
/// Where a face of a cell is ambiguous its inside corners are taken apart, on both of its sides, so
/// that the sheets of neighbouring cells fit together: the result is dual to a marching-cubes
/// surface, closed, and a manifold unless two sheets meet in two faces of one pair of cells (asked
/// of core/geometry/topology.h by callers that need it).
///
/// The function must be positive on the outermost points of the grid.
/// @throws Error  when it is not
/// Source: Gibson 1998, Constrained elastic surface nets; Nielson 2004, Dual marching cubes.
QuadMesh surface_nets(const GridFunction& f);

}  // namespace geoprior::sketch
