#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"

namespace geoprior::sketch {

/// A point on an edge of a mesh, or one of its vertices.
struct EdgePoint {
  Edge edge{};       ///< lower vertex first; twice the same for a vertex
  double share = 0;  ///< of the way from the first to the second, above 0 and below 1; 0: a vertex

  [[nodiscard]] bool is_vertex() const { return edge[0] == edge[1]; }
  [[nodiscard]] Eigen::RowVector3d position(const Eigen::MatrixX3d& V) const {
    return (1 - share) * V.row(edge[0]) + share * V.row(edge[1]);
  }
};

/// A path that passes this near to a vertex, as a share of the edge, runs through the vertex: cut
/// there, the edge would leave a sliver.
inline constexpr double kSnapShare = 1.0 / 6;

inline EdgePoint at_vertex(int v) { return {{v, v}, 0}; }

/// A path over a surface: consecutive points lie on one triangle.
using SurfacePath = std::vector<EdgePoint>;

/// The same path in the numbers that its vertices have elsewhere.
/// @param number  of each vertex
SurfacePath renumbered(const SurfacePath& path, const std::vector<int>& number);

/// Length of a path (m).
double length(const SurfacePath& path, const Eigen::MatrixX3d& V);

/// Shortest paths across the triangles of a surface, each of which has a price by the metre.
///
/// Dijkstra's algorithm over the vertices and three points of every edge, joined within triangles;
/// the path that it finds is then pulled taut in the strip of triangles that it passes. Paths are a
/// few percent longer than the shortest ones at most, and as smooth as the surface. They stay off
/// the border but for their ends.
///
/// Equal costs are decided by index; the result depends on the mesh alone.
/// Source: Lanthier, Maheshwari and Sack 2001, Approximating shortest paths on weighted polyhedral
/// surfaces (points on edges).
class SurfacePaths {
 public:
  /// @param price  of each triangle, positive (1/m)
  SurfacePaths(const TriMesh& mesh, Eigen::VectorXd price);

  /// @param targets  not 0 for the vertices at any of which it may end
  /// @return         from `from` to a target; empty when there is none within reach
  [[nodiscard]] SurfacePath shortest(int from, const std::vector<char>& targets) const;
  /// What a path costs, at the lower price where it runs along an edge.
  [[nodiscard]] double cost(const SurfacePath& path) const;

 private:
  struct Search;
  [[nodiscard]] Eigen::RowVector3d position(int node) const;
  [[nodiscard]] EdgePoint point(int node) const;
  void pull_taut(SurfacePath& path, const std::vector<int>& triangles) const;

  const TriMesh& mesh_;
  Eigen::VectorXd price_;
  EdgeConnectivity edges_;
  VertexCorners corners_;
  std::vector<char> border_;  ///< of each vertex
};

}  // namespace geoprior::sketch
