#include "core/connectivity.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

/// Counting sort of the corners by vertex. `vertex_of(t, k)` is corner k of triangle t.
template <class VertexOf>
void sort_corners(int triangle_count, int vertex_count, const VertexOf& vertex_of,
                  std::vector<int>& begin, std::vector<int>& corner) {
  begin.assign(vertex_count + 1, 0);
  for (int t = 0; t < triangle_count; ++t) {
    for (int k = 0; k < 3; ++k) ++begin[vertex_of(t, k) + 1];
  }
  for (int v = 0; v < vertex_count; ++v) begin[v + 1] += begin[v];
  corner.resize(3 * triangle_count);
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int t = 0; t < triangle_count; ++t) {
    for (int k = 0; k < 3; ++k) corner[next[vertex_of(t, k)]++] = 3 * t + k;
  }
}

}  // namespace

EdgeConnectivity::EdgeConnectivity(const Eigen::MatrixX3i& F) : origin_(3 * F.rows()) {
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) origin_[3 * t + k] = F(t, k);
  }
  sort_half_edges();
}

EdgeConnectivity::EdgeConnectivity(std::span<const std::array<int, 3>> triangles) {
  origin_.reserve(3 * triangles.size());
  for (const auto& t : triangles) origin_.insert(origin_.end(), t.begin(), t.end());
  sort_half_edges();
}

void EdgeConnectivity::sort_half_edges() {
  const int count = half_edge_count();
  int vertex_count = 0;
  for (int h = 0; h < count; ++h) {
    if (origin_[h] < 0) {
      throw Error("no vertex " + std::to_string(origin_[h]), "triangle " + std::to_string(h / 3),
                  "0 or more");
    }
    vertex_count = std::max(vertex_count, origin_[h] + 1);
  }
  // A counting sort by the lower vertex leaves few half-edges to be sorted by the higher one, each
  // as one number: higher vertex, half-edge.
  std::vector<int> place(vertex_count + 1, 0);
  for (int h = 0; h < count; ++h) ++place[std::min(origin(h), tip(h)) + 1];
  for (int v = 0; v < vertex_count; ++v) place[v + 1] += place[v];
  std::vector<std::uint64_t> key(count);
  for (int h = 0; h < count; ++h) {
    const auto [low, high] = std::minmax(origin_[h], origin_[next(h)]);
    key[place[low]++] = static_cast<std::uint64_t>(high) << 32U | static_cast<std::uint64_t>(h);
  }
  edge_of_.resize(count);
  half_edge_.resize(count);
  edges_.reserve(count / 2 + 1);
  begin_.reserve(count / 2 + 2);
  for (int low = 0, i = 0; low < vertex_count; ++low) {
    const int end = place[low];  // moved on to where the next vertex began
    std::sort(key.begin() + i, key.begin() + end);
    for (int last = -1; i < end; ++i) {
      const auto high = static_cast<int>(key[i] >> 32U);
      if (high != last) {
        edges_.push_back({low, high});
        begin_.push_back(i);
        last = high;
      }
      half_edge_[i] = static_cast<int>(key[i] & 0xFFFFFFFFU);
      edge_of_[half_edge_[i]] = edge_count() - 1;
    }
  }
  begin_.push_back(count);
  valence_.assign(vertex_count, 0);
  ring_begin_.assign(vertex_count, -1);
  find_ring_begins();
}

/// The ring of a vertex begins with the neighbour from which no half-edge comes back, the last of
/// them if there are several, or else with the lowest neighbour.
void EdgeConnectivity::find_ring_begins() {
  for (int e = 0; e < edge_count(); ++e) {
    const auto [low, high] = edges_[e];
    const int up = half_edge_from(low, e), down = half_edge_from(high, e);
    const auto look_at = [&](int vertex, int out, int back) {
      if (back < 0 || valence_[vertex] == 0) ring_begin_[vertex] = out;
      ++valence_[vertex];
    };
    look_at(low, up, down);
    if (high != low) look_at(high, down, up);
  }
}

std::vector<std::array<int, 3>> EdgeConnectivity::across() const {
  std::vector<std::array<int, 3>> result(half_edge_count() / 3, {-1, -1, -1});
  for (int e = 0; e < edge_count(); ++e) {
    const std::span<const int> both = half_edges(e);
    if (both.size() != 2) continue;
    result[both[0] / 3][both[0] % 3] = both[1] / 3;
    result[both[1] / 3][both[1] % 3] = both[0] / 3;
  }
  return result;
}

int EdgeConnectivity::triangle_beside(int edge, bool ascending) const {
  for (const int h : half_edges(edge)) {
    if (ascends(h) == ascending) return h / 3;
  }
  return -1;
}

std::optional<int> EdgeConnectivity::find(int u, int v) const {
  const Edge wanted{std::min(u, v), std::max(u, v)};
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), wanted);
  if (at == edges_.end() || *at != wanted) return std::nullopt;
  return static_cast<int>(at - edges_.begin());
}

int EdgeConnectivity::half_edge_from(int vertex, int edge) const {
  for (const int h : half_edges(edge)) {
    if (origin(h) == vertex) return h;
  }
  return -1;
}

bool EdgeConnectivity::has_ring(int vertex) const {
  const int all = valence(vertex);
  if (all == 0) return true;
  const int begin = ring_begin(vertex);
  int seen = 1;
  for (int h = begin; h >= 0 && seen <= all; ++seen) {
    const int back = previous(h);
    if (origin(back) == tip(begin)) break;
    h = half_edge_from(vertex, edge_of(back));
    if (h < 0) return seen + 1 == all;
  }
  return begin >= 0 && seen == all;
}

Ring ring(const EdgeConnectivity& edges, int vertex) {
  if (!edges.has_ring(vertex)) {
    throw Error("the triangles at it are no single fan", "vertex " + std::to_string(vertex),
                "a vertex of a consistently oriented manifold");
  }
  return {RingIterator(edges, vertex)};
}

std::optional<int> EdgeConnectivity::first_repeated() const {
  std::optional<int> first;
  for (int e = 0; e < edge_count(); ++e) {
    const std::span<const int> here = half_edges(e);
    if (here.size() == 1 || (here.size() == 2 && ascends(here[0]) != ascends(here[1]))) continue;
    bool up = false, down = false;
    for (const int h : here) {
      bool& taken = ascends(h) ? up : down;
      if (taken && (!first || h < *first)) first = h;
      taken = true;
    }
  }
  return first;
}

VertexCorners::VertexCorners(const Eigen::MatrixX3i& F, int vertex_count) {
  sort_corners(
      static_cast<int>(F.rows()), vertex_count, [&](int t, int k) { return F(t, k); }, begin_,
      corner_);
}

VertexCorners::VertexCorners(std::span<const std::array<int, 3>> triangles, int vertex_count) {
  sort_corners(
      static_cast<int>(triangles.size()), vertex_count,
      [&](int t, int k) { return triangles[t][k]; }, begin_, corner_);
}

}  // namespace geoprior
