#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/connectivity.h"

namespace geoprior::paper {

/// Connectivity of a sheet and its pattern coordinates: a triangulation of the pattern, triangles
/// counter-clockwise in it.
struct ShellMesh {
  Eigen::MatrixX2d pattern;    ///< n x 2 (m)
  Eigen::MatrixX3i triangles;  ///< m x 3
  /// Edges that are rulings, ascending; the edges in the strips between them fold against a
  /// stiffness of their own. None: all edges are alike.
  std::vector<Edge> rulings = {};

  [[nodiscard]] int vertex_count() const { return static_cast<int>(pattern.rows()); }
  [[nodiscard]] int triangle_count() const { return static_cast<int>(triangles.rows()); }
};

/// All that a sheet remembers from one step to the next.
struct ShellState {
  ShellMesh mesh;
  Eigen::MatrixX3d x;  ///< n x 3 (m)
  Eigen::MatrixX3d v;  ///< n x 3 (m/s)
  /// Rest shape operator S_p of each triangle in pattern axes: S_uu, S_uv, S_vv (1/m).
  Eigen::MatrixX3d plastic_curvature;
  Eigen::VectorXd damage;  ///< of each triangle: accumulated plastic excess |S_el| / yield - 1
  double time = 0;         ///< s
};

/// Area of a triangle in the pattern, negative when it is turned over there (m^2).
double pattern_area(const ShellMesh& mesh, int t);

/// Mean normal of the triangles about a vertex, those with more area counting more.
/// @param corners  of the state's mesh
Eigen::Vector3d vertex_normal(const ShellState& state, const VertexCorners& corners, int vertex);

}  // namespace geoprior::paper
