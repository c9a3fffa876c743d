#include "models/sketch/surface/path.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace geoprior::sketch {
namespace {

constexpr int kPointsOfEdge = 3;

}  // namespace

SurfacePath renumbered(const SurfacePath& path, const std::vector<int>& number) {
  SurfacePath result;
  for (const EdgePoint& point : path) {
    const Edge e{number[point.edge[0]], number[point.edge[1]]};
    if (e[0] <= e[1]) {
      result.push_back({e, point.share});
    } else {
      result.push_back({{e[1], e[0]}, 1 - point.share});
    }
  }
  return result;
}

double length(const SurfacePath& path, const Eigen::MatrixX3d& V) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum += (path[i].position(V) - path[i - 1].position(V)).norm();
  return sum;
}

SurfacePaths::SurfacePaths(const TriMesh& mesh, Eigen::VectorXd price)
    : mesh_(mesh),
      price_(std::move(price)),
      edges_(mesh.F),
      corners_(mesh.F, mesh.vertex_count()),
      border_(mesh.vertex_count(), 0) {
  for (int e = 0; e < edges_.edge_count(); ++e) {
    if (edges_.half_edges(e).size() == 2) continue;
    for (const int v : edges_.edge(e)) border_[v] = 1;
  }
}

/// Nodes are the vertices, then the points of every edge from its lower vertex on.
struct SurfacePaths::Search {
  explicit Search(const SurfacePaths& paths)
      : cost(paths.mesh_.vertex_count() + kPointsOfEdge * paths.edges_.edge_count(),
             std::numeric_limits<double>::infinity()),
        before(cost.size(), -1),
        through(cost.size(), -1) {}

  std::vector<double> cost;
  std::vector<int> before;   ///< node
  std::vector<int> through;  ///< triangle
};

EdgePoint SurfacePaths::point(int node) const {
  const int n = mesh_.vertex_count();
  if (node < n) return at_vertex(node);
  const int k = (node - n) % kPointsOfEdge;
  return {edges_.edge((node - n) / kPointsOfEdge), (k + 1.0) / (kPointsOfEdge + 1)};
}

Eigen::RowVector3d SurfacePaths::position(int node) const { return point(node).position(mesh_.V); }

SurfacePath SurfacePaths::shortest(int from, const std::vector<char>& targets) const {
  using Reached = std::pair<double, int>;
  const int n = mesh_.vertex_count();
  Search search(*this);
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  search.cost[from] = 0;
  queue.emplace(0.0, from);
  int end = -1;
  while (!queue.empty() && end < 0) {
    const auto [cost, node] = queue.top();
    queue.pop();
    if (cost > search.cost[node]) continue;
    if (node < n && node != from) {
      if (targets[node]) end = node;
      if (targets[node] || border_[node]) continue;
    }
    const Eigen::RowVector3d here = position(node);
    const auto reach = [&](int other, int t) {
      const double sum = cost + price_(t) * (position(other) - here).norm();
      if (sum >= search.cost[other]) return;
      search.cost[other] = sum;
      search.before[other] = node;
      search.through[other] = t;
      queue.emplace(sum, other);
    };
    const auto cross = [&](int t) {
      for (int k = 0; k < 3; ++k) {
        const int e = edges_.edge_of(3 * t + k);
        if (mesh_.F(t, k) != node) reach(mesh_.F(t, k), t);
        if (edges_.half_edges(e).size() < 2 || (node >= n && (node - n) / kPointsOfEdge == e))
          continue;
        for (int i = 0; i < kPointsOfEdge; ++i) reach(n + kPointsOfEdge * e + i, t);
      }
    };
    if (node < n) {
      for (const int corner : corners_.of(node)) cross(corner / 3);
    } else {
      for (const int h : edges_.half_edges((node - n) / kPointsOfEdge)) cross(h / 3);
    }
  }
  SurfacePath path;
  std::vector<int> triangles;
  for (int node = end; node >= 0; node = search.before[node]) {
    path.push_back(point(node));
    if (search.before[node] >= 0) triangles.push_back(search.through[node]);
  }
  std::reverse(path.begin(), path.end());
  std::reverse(triangles.begin(), triangles.end());
  pull_taut(path, triangles);
  return path;
}

double SurfacePaths::cost(const SurfacePath& path) const {
  const auto touches = [&](const EdgePoint& point, int t) {
    const auto corner = [&](int v) { return (mesh_.F.row(t).array() == v).any(); };
    return corner(point.edge[0]) && corner(point.edge[1]);
  };
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double price = std::numeric_limits<double>::infinity();
    for (const int corner : corners_.of(path[i].edge[0])) {
      const int t = corner / 3;
      if (touches(path[i], t) && touches(path[i - 1], t)) price = std::min(price, price_(t));
    }
    sum += price * (path[i].position(mesh_.V) - path[i - 1].position(mesh_.V)).norm();
  }
  return sum;
}

/// Every point slides along its edge to where the cost to its two neighbours is least, in turns.
/// @param triangles  between consecutive points
void SurfacePaths::pull_taut(SurfacePath& path, const std::vector<int>& triangles) const {
  constexpr int kSweeps = 60, kHalvings = 24;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
      if (path[i].is_vertex()) continue;
      const Eigen::RowVector3d a = path[i - 1].position(mesh_.V), b = path[i + 1].position(mesh_.V);
      const double pa = price_(triangles[i - 1]), pb = price_(triangles[i]);
      const Eigen::RowVector3d along = mesh_.V.row(path[i].edge[1]) - mesh_.V.row(path[i].edge[0]);
      // The cost is convex: its slope changes sign once.
      double low = 1e-3, high = 1 - 1e-3;
      for (int halving = 0; halving < kHalvings; ++halving) {
        path[i].share = (low + high) / 2;
        const Eigen::RowVector3d x = path[i].position(mesh_.V);
        const double slope =
            pa * along.dot((x - a).normalized()) + pb * along.dot((x - b).normalized());
        (slope > 0 ? high : low) = path[i].share;
      }
    }
  }
}

}  // namespace geoprior::sketch
