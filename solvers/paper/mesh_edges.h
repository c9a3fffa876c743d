#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace geoprior::paper {

/// Edges of a triangle mesh, sorted by their vertices, with the triangles on both sides.
class MeshEdges {
 public:
  struct Edge {
    int a, b;              ///< vertices, a < b
    int left, right = -1;  ///< triangles in which the edge runs a to b, and b to a; -1: none
  };
  explicit MeshEdges(const Eigen::MatrixX3i& triangles);

  [[nodiscard]] const std::vector<Edge>& all() const { return edges_; }
  /// Edge from corner k of a triangle to its next corner.
  [[nodiscard]] const Edge& of(int triangle, int k) const { return edges_[index_[triangle][k]]; }
  /// Index of the edge between two vertices, in any order.
  [[nodiscard]] std::optional<int> find(int u, int v) const;

 private:
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> index_;  ///< edges of each triangle
};

}  // namespace geoprior::paper
