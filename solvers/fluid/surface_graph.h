#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/mesh.h"

namespace geoprior::fluid {

/// A triangle mesh as the extraction walks it: positions and triangles side by side in memory, and
/// for every vertex its corners and its ring. Any mesh is taken; what is not a manifold shows as
/// `border`.
struct SurfaceGraph {
  std::vector<Eigen::Vector3d> x;            ///< m
  std::vector<std::array<int, 3>> triangle;  ///< vertices
  std::vector<int> corner_offset;            ///< n + 1
  std::vector<int> corner;                   ///< 3 t + k, ascending for each vertex
  std::vector<int> ring;                     ///< of v: from 2 corner_offset[v], ring_size[v] long
  std::vector<int> ring_size;
  std::vector<char> border;  ///< 1: the triangles around the vertex do not close

  [[nodiscard]] int size() const { return static_cast<int>(x.size()); }
  [[nodiscard]] std::span<const int> corners(int v) const {
    const auto i = static_cast<std::size_t>(v);
    return {corner.data() + corner_offset[i],
            static_cast<std::size_t>(corner_offset[i + 1] - corner_offset[i])};
  }
  [[nodiscard]] std::span<const int> neighbours(int v) const {
    const auto i = static_cast<std::size_t>(v);
    return {ring.data() + 2 * corner_offset[i], static_cast<std::size_t>(ring_size[i])};
  }
};

/// @throws Error  on a vertex that is not finite or an index out of range (named)
SurfaceGraph surface_graph(const TriMesh& mesh);

}  // namespace geoprior::fluid
