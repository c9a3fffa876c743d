#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"

namespace geoprior::fluid {

/// A triangle mesh as the extraction walks it: positions and triangles side by side in memory, and
/// for every vertex its corners and its ring. Any mesh is taken; what is not a manifold shows as
/// `border`.
struct SurfaceGraph {
  std::vector<Eigen::Vector3d> x;            ///< m
  std::vector<std::array<int, 3>> triangle;  ///< vertices
  VertexCorners corner;
  std::vector<int> ring;  ///< of v: from 2 corner.begin(v), ring_size[v] long
  std::vector<int> ring_size;
  std::vector<char> border;  ///< 1: the triangles around the vertex do not close

  [[nodiscard]] int size() const { return static_cast<int>(x.size()); }
  /// Corners 3 t + k, ascending.
  [[nodiscard]] std::span<const int> corners(int v) const { return corner.of(v); }
  [[nodiscard]] std::span<const int> neighbours(int v) const {
    return {ring.data() + 2 * corner.begin(v), static_cast<std::size_t>(ring_size[v])};
  }
};

/// @throws Error  on a vertex that is not finite or an index out of range (named)
SurfaceGraph surface_graph(const TriMesh& mesh);

}  // namespace geoprior::fluid
