#include "models/sketch/surface/shortest_cut.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::sketch {
namespace {

constexpr double kPathUnreached = std::numeric_limits<double>::infinity();

/// Finds cuts on one piece; `cut_` grows.
class CutFinder {
 public:
  explicit CutFinder(const TriMesh& piece)
      : piece_(piece),
        edges_(piece.F),
        cut_(edges_.edge_count(), false),
        rooted_(piece.vertex_count(), false),
        border_(piece.vertex_count()),
        at_border_(piece.vertex_count(), false) {
    list_neighbours();
    for (int e = 0; e < edges_.edge_count(); ++e) {
      if (!is_border(e)) continue;
      border_.join(edges_.edge(e)[0], edges_.edge(e)[1]);
      at_border_[edges_.edge(e)[0]] = at_border_[edges_.edge(e)[1]] = true;
    }
  }

  std::vector<Edge> find() {
    const auto first = std::find(at_border_.begin(), at_border_.end(), true);
    if (first == at_border_.end()) {
      rooted_[0] = true;
      open_handles();
      if (std::find(cut_.begin(), cut_.end(), true) == cut_.end()) slit();
    } else {
      root_border(static_cast<int>(first - at_border_.begin()));
      while (join_next_border()) {
      }
      open_handles();
    }
    std::vector<Edge> result;
    for (int e = 0; e < edges_.edge_count(); ++e) {
      if (cut_[e]) result.push_back(edges_.edge(e));
    }
    return result;
  }

 private:
  [[nodiscard]] bool is_border(int e) const { return edges_.half_edges(e).size() < 2; }
  [[nodiscard]] double length(int e) const {
    return (piece_.V.row(edges_.edge(e)[0]) - piece_.V.row(edges_.edge(e)[1])).norm();
  }
  [[nodiscard]] int other_end(int e, int v) const {
    return edges_.edge(e)[0] == v ? edges_.edge(e)[1] : edges_.edge(e)[0];
  }

  void list_neighbours();
  void root_border(int vertex);
  int spread(const std::function<bool(int)>& stop);
  void cut_back_from(int vertex);
  bool join_next_border();
  void open_handles();
  void slit();

  const TriMesh& piece_;
  EdgeConnectivity edges_;
  std::vector<int> begin_, edge_at_;  ///< edges at vertex v: from begin_[v] to begin_[v + 1]
  std::vector<bool> cut_;             ///< edges
  std::vector<bool> rooted_;          ///< vertices at distance 0: borders joined so far, cuts
  DisjointSets border_;
  std::vector<bool> at_border_;
  std::vector<double> distance_;
  std::vector<int> parent_;  ///< edge towards the root; -1 at it
};

void CutFinder::list_neighbours() {
  begin_.assign(piece_.vertex_count() + 1, 0);
  for (const Edge& edge : edges_.edges()) {
    for (const int v : edge) ++begin_[v + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  edge_at_.resize(2 * edges_.edges().size());
  std::vector<int> fill(begin_.begin(), begin_.end() - 1);
  for (int e = 0; e < edges_.edge_count(); ++e) {
    for (const int v : edges_.edge(e)) edge_at_[fill[v]++] = e;
  }
}

void CutFinder::root_border(int vertex) {
  for (int v = 0; v < piece_.vertex_count(); ++v) {
    if (at_border_[v] && border_.find(v) == border_.find(vertex)) rooted_[v] = true;
  }
}

/// Shortest paths from the root (Dijkstra) until a vertex at which `stop` holds.
/// @return  that vertex, or the one reached last
int CutFinder::spread(const std::function<bool(int)>& stop) {
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  distance_.assign(piece_.vertex_count(), kPathUnreached);
  parent_.assign(piece_.vertex_count(), -1);
  for (int v = 0; v < piece_.vertex_count(); ++v) {
    if (!rooted_[v]) continue;
    distance_[v] = 0;
    queue.emplace(0.0, v);
  }
  int last = queue.top().second;
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance_[v]) continue;
    last = v;
    if (stop(v)) break;
    for (int i = begin_[v]; i < begin_[v + 1]; ++i) {
      const int e = edge_at_[i], to = other_end(e, v);
      if (d + length(e) >= distance_[to]) continue;
      distance_[to] = d + length(e);
      parent_[to] = e;
      queue.emplace(distance_[to], to);
    }
  }
  return last;
}

void CutFinder::cut_back_from(int vertex) {
  while (parent_[vertex] >= 0 && !cut_[parent_[vertex]]) {
    cut_[parent_[vertex]] = true;
    vertex = other_end(parent_[vertex], vertex);
  }
}

bool CutFinder::join_next_border() {
  bool any = false;
  for (int v = 0; v < piece_.vertex_count(); ++v) any = any || (at_border_[v] && !rooted_[v]);
  if (!any) return false;
  const int reached = spread([&](int v) { return at_border_[v] && !rooted_[v]; });
  if (!at_border_[reached] || rooted_[reached]) throw Error("piece of surface is not connected");
  for (int v = reached; parent_[v] >= 0; v = other_end(parent_[v], v)) rooted_[v] = true;
  cut_back_from(reached);
  root_border(reached);
  return true;
}

/// With the root as one point the edges outside both the tree of shortest paths and a spanning tree
/// of the triangles are two a handle; the longest loops go into the spanning tree.
void CutFinder::open_handles() {
  spread([](int) { return false; });
  std::vector<bool> in_tree(edges_.edge_count(), false);
  for (int v = 0; v < piece_.vertex_count(); ++v) {
    if (distance_[v] == kPathUnreached) throw Error("piece of surface is not connected");
    if (parent_[v] >= 0) in_tree[parent_[v]] = true;
  }
  std::vector<int> candidates;
  std::vector<double> loop(edges_.edge_count());
  for (int e = 0; e < edges_.edge_count(); ++e) {
    if (is_border(e) || in_tree[e] || cut_[e]) continue;
    candidates.push_back(e);
    loop[e] = distance_[edges_.edge(e)[0]] + distance_[edges_.edge(e)[1]] + length(e);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](int e, int f) { return loop[e] > loop[f]; });
  DisjointSets triangles(piece_.triangle_count());
  for (const int e : candidates) {
    const int left = edges_.left(e), right = edges_.right(e);
    if (triangles.find(left) != triangles.find(right)) {
      triangles.join(left, right);
      continue;
    }
    cut_[e] = true;
    for (const int v : edges_.edge(e)) cut_back_from(v);
  }
}

void CutFinder::slit() {
  const auto never = [](int) { return false; };
  const int start = spread(never);
  rooted_.assign(rooted_.size(), false);
  rooted_[start] = true;
  const int end = spread(never);
  cut_back_from(end);
  if (other_end(parent_[end], end) != start) return;
  // A slit of one edge opens nothing: it goes on to another neighbour.
  for (int i = begin_[end]; i < begin_[end + 1]; ++i) {
    if (other_end(edge_at_[i], end) == start) continue;
    cut_[edge_at_[i]] = true;
    return;
  }
}

}  // namespace

std::vector<Edge> shortest_cut(const TriMesh& piece) {
  if (piece.triangle_count() == 0) return {};
  return CutFinder(piece).find();
}

}  // namespace geoprior::sketch
