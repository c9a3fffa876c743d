#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"

namespace geoprior {

/// Neighbours of every vertex in compressed rows: those of `v` are `neighbours[offset[v] ..
/// offset[v + 1])`.
struct VertexGraph {
  std::vector<int> offset;
  std::vector<int> neighbours;

  [[nodiscard]] std::span<const int> of(int v) const {
    const std::size_t begin = offset[v];
    const std::size_t end = offset[v + 1];
    return {neighbours.data() + begin, end - begin};
  }
};

/// The `ring` of every vertex, for those who walk around each of them more than once (mean-value
/// coordinates need the cyclic order). Where there is no such order, the neighbours ascend.
VertexGraph one_rings(const Eigen::MatrixX3i& F, int vertex_count);

/// Directed edges that have no opposite, in the order of the triangles: empty for a closed mesh.
std::vector<Edge> boundary_edges(const Eigen::MatrixX3i& F);

/// Edges with three or more triangles or with two of equal direction (inconsistent orientation),
/// each once.
std::vector<Edge> non_manifold_edges(const Eigen::MatrixX3i& F);

/// True for vertices on a boundary edge.
std::vector<bool> boundary_vertices(const Eigen::MatrixX3i& F, int vertex_count);

/// Mean length of the edges (m); 0 without any.
/// @param edges  of the triangles whose vertices are the rows of V
double mean_edge_length(const Eigen::MatrixX3d& V, const EdgeConnectivity& edges);

/// Throws Error naming up to five offending edges unless the mesh is closed, manifold and
/// consistently oriented. `who` is the method or metric that needs it; `where` names the mesh (a
/// file).
void require_closed_manifold(const TriMesh& mesh, const std::string& who, const std::string& where);

/// Vertices with equal positions merged into one.
struct Weld {
  TriMesh mesh;                      ///< welded; triangles that became degenerate are dropped
  std::vector<int> welded_of_split;  ///< for each input vertex, its welded vertex
  std::vector<int> split_of_welded;  ///< for each welded vertex, its first input vertex
};

/// Welds vertices whose positions are bitwise equal (-0 equals 0). Welded vertices keep the order
/// of first appearance.
/// @param part  of each vertex: those of different parts stay apart; empty: one part
Weld weld_by_position(const TriMesh& split, std::span<const int> part = {});

}  // namespace geoprior
