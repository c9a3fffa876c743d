#include "metrics/closedness.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/disjoint_sets.h"

namespace geoprior {
namespace {

/// A side of a triangle: lower vertex, higher vertex, whether it is passed from low to high.
struct Side {
  int low, high;
  bool forward;
  int triangle;
};

std::vector<Side> sorted_sides(const Eigen::MatrixX3i& F) {
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(F.rows()) * 3);
  for (int t = 0; t < F.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const int a = F(t, c), b = F(t, (c + 1) % 3);
      sides.push_back({std::min(a, b), std::max(a, b), a < b, t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::array{x.low, x.high, x.triangle} < std::array{y.low, y.high, y.triangle};
  });
  return sides;
}

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
      const auto v = static_cast<std::size_t>(F(t, c));
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
  const std::vector<Side> sides = sorted_sides(mesh.F);
  DisjointSets corners(3 * mesh.triangle_count());
  int edges = 0;
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    for (end = begin; end < sides.size() && sides[end].low == sides[begin].low &&
                      sides[end].high == sides[begin].high;) {
      ++end;
    }
    ++edges;
    const std::size_t n = end - begin;
    if (n == 1) ++result.border_edges;
    if (n > 2) ++result.crowded_edges;
    if (n == 2 && sides[begin].forward == sides[begin + 1].forward) ++result.turned_edges;
    const Side& first = sides[begin];
    for (const Side& side : std::span(sides).subspan(begin + 1, n - 1)) {
      for (const int v : {side.low, side.high}) {
        corners.join(corner_of(mesh.F, side.triangle, v), corner_of(mesh.F, first.triangle, v));
      }
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
  result.euler_characteristic = used_count - edges + mesh.triangle_count();
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
