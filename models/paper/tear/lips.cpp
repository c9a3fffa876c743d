#include "models/paper/tear/lips.h"

#include <algorithm>
#include <array>

#include "core/disjoint_sets.h"

namespace geoprior::paper {
namespace {

/// Edges of the opened mesh that were rulings.
std::vector<Edge> carried(const std::vector<Edge>& rulings, const Eigen::MatrixX3i& before,
                          const Eigen::MatrixX3i& after) {
  std::vector<Edge> result;
  for (int f = 0; f < before.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Edge old = undirected(before(f, k), before(f, next));
      if (std::binary_search(rulings.begin(), rulings.end(), old))
        result.push_back(undirected(after(f, k), after(f, next)));
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

void open_along(ShellMesh& mesh, const std::vector<Eigen::Vector2i>& along) {
  if (along.empty()) return;
  std::vector<Edge> lips;
  for (const Eigen::Vector2i& edge : along) lips.push_back(undirected(edge[0], edge[1]));
  std::sort(lips.begin(), lips.end());
  const Eigen::MatrixX3i before = mesh.triangles;
  const EdgeConnectivity edges(before);
  const VertexCorners corners(before, mesh.vertex_count());
  // Corners at a vertex that hang together over edges which stay.
  DisjointSets groups(static_cast<int>(before.size()));
  for (int h = 0; h < edges.half_edge_count(); ++h) {
    const int other = edges.twin(h);
    if (other < h) continue;
    const Edge& edge = edges.edge(edges.edge_of(h));
    if (std::binary_search(lips.begin(), lips.end(), edge)) continue;
    groups.join(h, EdgeConnectivity::next(other));
    groups.join(EdgeConnectivity::next(h), other);
  }
  std::vector<int> ends;
  for (const Edge& edge : lips) ends.insert(ends.end(), edge.begin(), edge.end());
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<int> source;
  for (const int v : ends) {
    std::vector<int> seen;
    for (const int c : corners.of(v)) {
      const int group = groups.find(c);
      auto at = std::find(seen.begin(), seen.end(), group);
      if (at == seen.end()) {
        seen.push_back(group);
        at = seen.end() - 1;
        if (seen.size() > 1) source.push_back(v);
      }
      if (at == seen.begin()) continue;
      const auto behind = static_cast<int>(seen.end() - at);
      mesh.triangles(c / 3, c % 3) = mesh.vertex_count() + static_cast<int>(source.size()) - behind;
    }
  }
  const int n = mesh.vertex_count();
  mesh.pattern.conservativeResize(n + source.size(), 2);
  for (std::size_t i = 0; i < source.size(); ++i) {
    mesh.pattern.row(n + i) = mesh.pattern.row(source[i]);
  }
  mesh.rulings = carried(mesh.rulings, before, mesh.triangles);
}

bool has_lips(const ShellMesh& mesh) {
  std::vector<std::array<double, 2>> places;
  places.reserve(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    places.push_back({mesh.pattern(v, 0), mesh.pattern(v, 1)});
  }
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) != places.end();
}

std::vector<int> parts(const Eigen::MatrixX3i& triangles) {
  const EdgeConnectivity edges(triangles);
  DisjointSets sets(static_cast<int>(triangles.rows()));
  for (int h = 0; h < edges.half_edge_count(); ++h) {
    if (edges.twin(h) > h) sets.join(h / 3, edges.twin(h) / 3);
  }
  std::vector<int> first(triangles.rows());
  for (int f = 0; f < sets.size(); ++f) first[f] = sets.find(f);
  return first;
}

std::vector<double> part_areas(const ShellMesh& mesh) {
  const std::vector<int> first = parts(mesh.triangles);
  std::vector<double> sum(first.size(), 0);
  for (int f = 0; f < mesh.triangle_count(); ++f) sum[first[f]] += pattern_area(mesh, f);
  std::vector<double> areas;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    if (first[f] == f) areas.push_back(sum[f]);
  }
  return areas;
}

int part_count(const Eigen::MatrixX3i& triangles) {
  const std::vector<int> first = parts(triangles);
  int count = 0;
  for (int f = 0; f < std::ssize(first); ++f) count += first[f] == f ? 1 : 0;
  return count;
}

}  // namespace geoprior::paper
