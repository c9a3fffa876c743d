#include "core/geometry/topology.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <unordered_map>

#include "core/error.h"

namespace geoprior {
namespace {

/// Half-edges that no half-edge of the same edge runs against. A triangle that names a vertex twice
/// has no border there.
std::vector<Edge> open_edges(const EdgeConnectivity& c) {
  std::vector<Edge> open;
  for (int h = 0; h < c.half_edge_count(); ++h) {
    if (c.origin(h) == c.tip(h)) continue;
    const std::span<const int> here = c.half_edges(c.edge_of(h));
    if (std::none_of(here.begin(), here.end(), [&](int g) { return c.ascends(g) != c.ascends(h); }))
      open.push_back({c.origin(h), c.tip(h)});
  }
  return open;
}

/// Edges with two half-edges of one direction, in the order of the first such direction.
std::vector<Edge> repeated_edges(const EdgeConnectivity& c) {
  std::vector<Edge> repeated;  // directed
  for (int e = 0; e < c.edge_count(); ++e) {
    const std::span<const int> here = c.half_edges(e);
    const auto up = std::count_if(here.begin(), here.end(), [&](int h) { return c.ascends(h); });
    const auto down = std::ssize(here) - up;
    const auto [low, high] = c.edge(e);
    if (up > 1) {
      repeated.push_back({low, high});
    } else if (down > 1) {
      repeated.push_back({high, low});
    }
  }
  std::sort(repeated.begin(), repeated.end());
  for (Edge& e : repeated) e = {std::min(e[0], e[1]), std::max(e[0], e[1])};
  return repeated;
}

std::string edge_list(const std::vector<Edge>& edges) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(edges.size(), 5); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(edges[i][0]) + "-" + std::to_string(edges[i][1]);
  }
  if (edges.size() > 5) text += ", and " + std::to_string(edges.size() - 5) + " more";
  return text;
}

struct PositionHash {
  std::size_t operator()(const std::array<std::uint64_t, 4>& key) const {
    std::uint64_t h = 0;
    for (const std::uint64_t k : key) h = (std::rotl(h, 5) ^ k) * 0x9E3779B97F4A7C15ULL;
    return h ^ (h >> 32);
  }
};

}  // namespace

VertexGraph one_rings(const Eigen::MatrixX3i& F, int vertex_count) {
  const EdgeConnectivity edges(F);
  VertexGraph graph;
  graph.offset.assign(1, 0);
  for (int v = 0; v < vertex_count; ++v) graph.offset.push_back(graph.offset[v] + edges.valence(v));
  graph.neighbours.resize(graph.offset.back());
  std::vector<int> next(graph.offset.begin(), graph.offset.end() - 1);
  for (const auto& [low, high] : edges.edges()) {  // ascends, and so do the neighbours
    graph.neighbours[next[low]++] = high;
    if (low != high) graph.neighbours[next[high]++] = low;
  }
  for (int v = 0; v < vertex_count; ++v) {
    if (edges.has_ring(v))
      std::ranges::copy(ring(edges, v), graph.neighbours.begin() + graph.offset[v]);
  }
  return graph;
}

std::vector<Edge> boundary_edges(const Eigen::MatrixX3i& F) {
  return open_edges(EdgeConnectivity(F));
}

std::vector<Edge> non_manifold_edges(const Eigen::MatrixX3i& F) {
  return repeated_edges(EdgeConnectivity(F));
}

std::vector<bool> boundary_vertices(const Eigen::MatrixX3i& F, int vertex_count) {
  std::vector<bool> on_boundary(vertex_count, false);
  for (const Edge& e : boundary_edges(F)) {
    on_boundary[e[0]] = true;
    on_boundary[e[1]] = true;
  }
  return on_boundary;
}

double mean_edge_length(const Eigen::MatrixX3d& V, const EdgeConnectivity& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges.edges()) sum += (V.row(a) - V.row(b)).norm();
  return edges.edge_count() > 0 ? sum / edges.edge_count() : 0;
}

void require_closed_manifold(const TriMesh& mesh, const std::string& who,
                             const std::string& where) {
  const EdgeConnectivity connectivity(mesh.F);
  const std::vector<Edge> bad = repeated_edges(connectivity);
  if (!bad.empty()) {
    throw Error(
        who + " needs a manifold mesh; " + std::to_string(bad.size()) +
            " edges have more than two triangles or two of equal direction: " + edge_list(bad),
        where, "two triangles of opposite direction at every edge");
  }
  const std::vector<Edge> open = open_edges(connectivity);
  if (!open.empty()) {
    throw Error(who + " needs a closed mesh; " + std::to_string(open.size()) +
                    " boundary edges: " + edge_list(open),
                where, "two triangles of opposite direction at every edge");
  }
}

Weld weld_by_position(const TriMesh& split, std::span<const int> part) {
  Weld weld;
  std::unordered_map<std::array<std::uint64_t, 4>, int, PositionHash> seen;
  for (int v = 0; v < split.vertex_count(); ++v) {
    std::array<std::uint64_t, 4> key{};
    for (int k = 0; k < 3; ++k) key[k] = std::bit_cast<std::uint64_t>(split.V(v, k) + 0.0);
    if (!part.empty()) key[3] = static_cast<std::uint64_t>(part[v]);
    const auto [it, is_new] = seen.emplace(key, static_cast<int>(weld.split_of_welded.size()));
    if (is_new) weld.split_of_welded.push_back(v);
    weld.welded_of_split.push_back(it->second);
  }
  weld.mesh.V.resize(weld.split_of_welded.size(), 3);
  for (Eigen::Index v = 0; v < weld.mesh.V.rows(); ++v) {
    weld.mesh.V.row(v) = split.V.row(weld.split_of_welded[v]);
  }
  weld.mesh.F.resize(split.F.rows(), 3);
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < split.F.rows(); ++t) {
    Eigen::RowVector3i f;
    for (int k = 0; k < 3; ++k) f(k) = weld.welded_of_split[split.F(t, k)];
    if (f(0) != f(1) && f(1) != f(2) && f(2) != f(0)) weld.mesh.F.row(kept++) = f;
  }
  weld.mesh.F.conservativeResize(kept, 3);
  return weld;
}

}  // namespace geoprior
