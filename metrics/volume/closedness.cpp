#include "metrics/volume/closedness.h"

#include <span>
#include <vector>

#include "core/connectivity.h"
#include "core/disjoint_sets.h"

namespace geoprior {
namespace {

/// Vertices joined by common triangles.
DisjointSets vertex_sets(const TriMesh& mesh) {
  DisjointSets vertices(mesh.vertex_count());
  for (int t = 0; t < mesh.F.rows(); ++t) {
    for (int c = 1; c < 3; ++c) vertices.join(mesh.F(t, c), mesh.F(t, 0));
  }
  return vertices;
}

int corner_of(const Eigen::MatrixX3i& F, int triangle, int vertex) {
  for (int c = 0; c < 3; ++c) {
    if (F(triangle, c) == vertex) return 3 * triangle + c;
  }
  return 3 * triangle;
}

/// Vertices whose corners are not all joined across common edges.
int pinched(const Eigen::MatrixX3i& F, int vertex_count, DisjointSets& corners) {
  std::vector<int> fan(vertex_count, -1);
  std::vector<char> counted(vertex_count, 0);
  int count = 0;
  for (int t = 0; t < F.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const std::size_t v = F(t, c);
      const int root = corners.find(3 * t + c);
      if (fan[v] < 0) fan[v] = root;
      if (fan[v] != root && counted[v] == 0) {
        counted[v] = 1;
        ++count;
      }
    }
  }
  return count;
}

}  // namespace

Closedness closedness(const TriMesh& mesh) {
  Closedness result;
  const EdgeConnectivity connectivity(mesh.F);
  DisjointSets corners(3 * mesh.triangle_count());
  for (int e = 0; e < connectivity.edge_count(); ++e) {
    const std::span<const int> here = connectivity.half_edges(e);
    if (here.size() == 1) ++result.border_edges;
    if (here.size() > 2) ++result.crowded_edges;
    if (here.size() == 2 && connectivity.ascends(here[0]) == connectivity.ascends(here[1]))
      ++result.turned_edges;
    for (const int h : here.subspan(1)) {
      for (const int v : connectivity.edge(e))
        corners.join(corner_of(mesh.F, h / 3, v), corner_of(mesh.F, here[0] / 3, v));
    }
  }
  result.pinched_vertices = pinched(mesh.F, mesh.vertex_count(), corners);
  DisjointSets vertices = vertex_sets(mesh);
  std::vector<char> used(mesh.vertex_count(), 0);
  for (const int v : mesh.F.reshaped()) used[v] = 1;
  int used_count = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (used[v] == 0) continue;
    ++used_count;
    if (vertices.find(v) == v) ++result.components;
  }
  result.euler_characteristic = used_count - connectivity.edge_count() + mesh.triangle_count();
  return result;
}

Eigen::MatrixX3i largest_component(const TriMesh& mesh) {
  DisjointSets vertices = vertex_sets(mesh);
  std::vector<int> count(mesh.vertex_count(), 0);
  int largest = -1;
  for (int t = 0; t < mesh.F.rows(); ++t) {
    const int set = vertices.find(mesh.F(t, 0));
    ++count[set];
  }
  for (int t = 0; t < mesh.F.rows(); ++t) {
    const int set = vertices.find(mesh.F(t, 0));
    if (largest < 0 || count[set] > count[largest]) {
      largest = set;
    }
  }
  Eigen::MatrixX3i kept(largest < 0 ? 0 : count[largest], 3);
  Eigen::Index next = 0;
  for (int t = 0; t < mesh.F.rows(); ++t) {
    if (vertices.find(mesh.F(t, 0)) == largest) kept.row(next++) = mesh.F.row(t);
  }
  return kept;
}

}  // namespace geoprior
