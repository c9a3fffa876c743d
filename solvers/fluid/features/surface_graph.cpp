#include "solvers/fluid/features/surface_graph.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kGraphBlock = 2048;

void copy_vertices(const TriMesh& mesh, SurfaceGraph& g) {
  const std::size_t n = mesh.vertex_count();
  g.x.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    g.x[v] = mesh.V.row(v).transpose();
    if (!g.x[v].allFinite()) {
      throw Error("position is not finite", "vertex " + std::to_string(v), "finite coordinates");
    }
  }
}

void copy_triangles(const TriMesh& mesh, SurfaceGraph& g) {
  const auto n = mesh.vertex_count();
  g.triangle.resize(mesh.triangle_count());
  for (std::size_t t = 0; t < g.triangle.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.F(t, k);
      if (v < 0 || v >= n) {
        throw Error("no vertex " + std::to_string(v), "triangle " + std::to_string(t),
                    "0 to " + std::to_string(n - 1));
      }
      g.triangle[t][k] = v;
    }
  }
}

/// Every triangle around v leads from one neighbour to the next: the ring is those led from, and at
/// a border also those only led to. A neighbour met twice is no manifold.
void collect_ring(SurfaceGraph& g, int v) {
  int* const begin = g.ring.data() + 2 * g.corner.begin(v);
  int* end = begin;
  bool closed = !g.corners(v).empty();
  for (const int c : g.corners(v)) {
    const auto& t = g.triangle[c / 3];
    const int from = t[(c + 1) % 3];
    if (std::find(begin, end, from) != end) {
      closed = false;
    } else {
      *end++ = from;
    }
  }
  int* const led_from = end;
  for (const int c : g.corners(v)) {
    const auto& t = g.triangle[c / 3];
    const int to = t[(c + 2) % 3];
    if (std::find(begin, led_from, to) != led_from) continue;
    closed = false;
    if (std::find(led_from, end, to) == end) *end++ = to;
  }
  g.ring_size[v] = static_cast<int>(end - begin);
  g.border[v] = closed ? 0 : 1;
}

}  // namespace

SurfaceGraph surface_graph(const TriMesh& mesh) {
  SurfaceGraph g;
  copy_vertices(mesh, g);
  copy_triangles(mesh, g);
  g.corner = VertexCorners(g.triangle, mesh.vertex_count());
  g.ring.resize(6 * g.triangle.size());
  g.ring_size.resize(g.x.size());
  g.border.resize(g.x.size());
  parallel_blocks(g.x.size(), kGraphBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) collect_ring(g, static_cast<int>(v));
  });
  return g;
}

}  // namespace geoprior::fluid
