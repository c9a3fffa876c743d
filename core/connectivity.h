#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

namespace geoprior {

/// Two vertices: of an undirected edge the lower one first, of a directed edge its start.
using Edge = std::array<int, 2>;

/// The undirected edge between two vertices in any order.
constexpr Edge undirected(int a, int b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// The edges of a list of triangles, and the half-edges at each of them.
///
/// Half-edge h = 3 t + k runs from corner k of triangle t to its next corner. Edges ascend by their
/// vertices and the half-edges of an edge by number, so that what is summed over them depends on
/// the triangles alone. On a consistently oriented manifold an edge has two half-edges that run
/// opposite ways, or one at the border; other lists of triangles are taken too, to be repaired,
/// counted or refused (`first_repeated`).
///
/// Time and memory are linear in the number of triangles and the largest index, up to sorting
/// edges with the same lower vertex.
class EdgeConnectivity {
 public:
  /// @param F       m x 3 vertices
  /// @throws Error  on a negative index (names its triangle)
  explicit EdgeConnectivity(const Eigen::MatrixX3i& F);
  explicit EdgeConnectivity(std::span<const std::array<int, 3>> triangles);

  [[nodiscard]] int half_edge_count() const { return static_cast<int>(origin_.size()); }
  [[nodiscard]] int edge_count() const { return static_cast<int>(edges_.size()); }
  /// One more than the largest index.
  [[nodiscard]] int vertex_count() const { return static_cast<int>(valence_.size()); }

  static constexpr int next(int half_edge) {
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
  }
  static constexpr int previous(int half_edge) {
    return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1;
  }
  [[nodiscard]] int origin(int half_edge) const { return origin_[half_edge]; }
  [[nodiscard]] int tip(int half_edge) const { return origin_[next(half_edge)]; }
  /// Whether it runs from the lower vertex to the higher one.
  [[nodiscard]] bool ascends(int half_edge) const { return origin(half_edge) < tip(half_edge); }
  [[nodiscard]] int edge_of(int half_edge) const { return edge_of_[half_edge]; }
  /// The other half-edge of an edge that has two, whatever their directions; otherwise -1.
  [[nodiscard]] int twin(int half_edge) const {
    const std::span<const int> both = half_edges(edge_of(half_edge));
    if (both.size() != 2) return -1;
    return both[0] == half_edge ? both[1] : both[0];
  }

  /// Triangle across the edge from corner k of a triangle to its next corner; -1 at the border, and
  /// where the edge has more than two triangles.
  [[nodiscard]] int across(int triangle, int k) const {
    const int other = twin(3 * triangle + k);
    return other < 0 ? -1 : other / 3;
  }
  /// The triangles across the three edges of every triangle, as `across(triangle, k)` gives them.
  [[nodiscard]] std::vector<std::array<int, 3>> across() const;

  /// Lower and higher vertex of every edge, ascending.
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  [[nodiscard]] const Edge& edge(int edge) const { return edges_[edge]; }
  /// Ascending; one or more.
  [[nodiscard]] std::span<const int> half_edges(int edge) const {
    const int begin = begin_[edge], end = begin_[edge + 1];
    return {half_edge_.data() + begin, static_cast<std::size_t>(end - begin)};
  }
  /// Triangle in which an edge runs from its lower to its higher vertex; -1: none.
  [[nodiscard]] int left(int edge) const { return triangle_beside(edge, true); }
  /// Triangle in which it runs from the higher to the lower one; -1: none.
  [[nodiscard]] int right(int edge) const { return triangle_beside(edge, false); }
  /// Edge between two vertices, in any order; none where there is no such edge. By bisection.
  [[nodiscard]] std::optional<int> find(int u, int v) const;

  /// Number of neighbours of a vertex; 0 for one without triangles.
  [[nodiscard]] int valence(int vertex) const {
    return vertex < vertex_count() ? valence_[vertex] : 0;
  }
  /// Whether the triangles at a vertex join its neighbours in one cycle or one chain, as they do on
  /// a consistently oriented manifold.
  [[nodiscard]] bool has_ring(int vertex) const;
  /// Half-edge out of a vertex with triangles with which its ring begins; of a vertex without a
  /// ring, any one or -1.
  [[nodiscard]] int ring_begin(int vertex) const { return ring_begin_[vertex]; }
  /// First half-edge from a vertex along an edge at it; -1 where none leaves it.
  [[nodiscard]] int half_edge_from(int vertex, int edge) const;

  /// First half-edge that runs the same way as an earlier one of its edge. There is one just where
  /// the triangles are no consistently oriented manifold along an edge: of three half-edges two run
  /// the same way.
  [[nodiscard]] std::optional<int> first_repeated() const;

 private:
  void sort_half_edges();
  void find_ring_begins();
  [[nodiscard]] int triangle_beside(int edge, bool ascending) const;

  std::vector<int> origin_;     ///< of each half-edge
  std::vector<int> edge_of_;    ///< of each half-edge
  std::vector<int> half_edge_;  ///< of edge e: from begin_[e] to begin_[e + 1]
  std::vector<int> begin_;      ///< edge count + 1
  std::vector<Edge> edges_;
  std::vector<int> valence_;     ///< of each vertex
  std::vector<int> ring_begin_;  ///< of each vertex; -1: no half-edge leaves it there
};

/// Walks over the neighbours of a vertex, from triangle to triangle.
class RingIterator {
 public:
  using value_type = int;
  using difference_type = std::ptrdiff_t;

  RingIterator() = default;
  /// @param vertex  one that has a ring
  RingIterator(const EdgeConnectivity& edges, int vertex)
      : edges_(&edges), vertex_(vertex), left_(edges.valence(vertex)) {
    if (left_ == 0) return;
    half_edge_ = edges.ring_begin(vertex);
    neighbour_ = edges.tip(half_edge_);
  }

  int operator*() const { return neighbour_; }
  RingIterator& operator++() {
    if (--left_ == 0) return *this;
    const int back = EdgeConnectivity::previous(half_edge_);
    neighbour_ = edges_->origin(back);
    half_edge_ = edges_->half_edge_from(vertex_, edges_->edge_of(back));
    return *this;
  }
  RingIterator operator++(int) {
    RingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const RingIterator& it, std::default_sentinel_t) { return it.left_ == 0; }

 private:
  const EdgeConnectivity* edges_ = nullptr;
  int vertex_ = -1;
  int half_edge_ = -1;  ///< to the neighbour; -1 at the last one of a border vertex
  int neighbour_ = -1;
  int left_ = 0;  ///< neighbours from this one on
};

/// Range of the neighbours of a vertex; see `ring`.
struct Ring {
  RingIterator first;

  [[nodiscard]] RingIterator begin() const { return first; }
  [[nodiscard]] std::default_sentinel_t end() const { return {}; }
};

/// The neighbours of a vertex in the order around it, each once:
/// `for (const int v : ring(edges, i))`.
///
/// They follow each other counter-clockwise, seen from outside. Around a vertex inside the surface
/// they begin with the lowest one; at the border they run from one border edge to the other: from
/// the one that a triangle runs out along, to the one that a triangle comes back along. A vertex
/// without triangles has none. Each step is a look at one edge; nothing is stored.
///
/// @param edges   outlives the range
/// @throws Error  where the neighbours lie in no such order, as at a vertex in which two fans meet
///                or at an edge with three triangles (names the vertex)
Ring ring(const EdgeConnectivity& edges, int vertex);

/// The corners of triangles at every vertex: corner c = 3 t + k is corner k of triangle t. Linear.
class VertexCorners {
 public:
  VertexCorners() = default;
  /// @param F             m x 3 vertices, 0 ... vertex_count - 1
  VertexCorners(const Eigen::MatrixX3i& F, int vertex_count);
  VertexCorners(std::span<const std::array<int, 3>> triangles, int vertex_count);

  /// Ascending; none for a vertex without triangles.
  [[nodiscard]] std::span<const int> of(int vertex) const {
    return {corner_.data() + begin_[vertex], static_cast<std::size_t>(count(vertex))};
  }
  [[nodiscard]] int count(int vertex) const { return begin_[vertex + 1] - begin_[vertex]; }
  /// Number of corners at the vertices before this one.
  [[nodiscard]] int begin(int vertex) const { return begin_[vertex]; }

 private:
  std::vector<int> begin_;   ///< vertex count + 1
  std::vector<int> corner_;  ///< of vertex v: from begin_[v] to begin_[v + 1]
};

}  // namespace geoprior
