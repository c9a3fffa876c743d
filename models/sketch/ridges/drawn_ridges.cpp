#include "models/sketch/ridges/drawn_ridges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>

namespace geoprior::sketch {
namespace {

/// Number of the corner that a place lies on, or -1.
int corner_at(const std::optional<SilhouettePlace>& place, const std::vector<double>& corners,
              double length, double near) {
  if (!place) return -1;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (std::abs(std::remainder(place->arc_length - corners[c], length)) < near)
      return static_cast<int>(c);
  }
  return -1;
}

/// Leaves one edge of a triangle that lies on one corner with all its vertices: the longest.
std::set<Edge> edges_within_corners(const TriMesh& mesh, const std::vector<int>& corner_of) {
  std::set<Edge> within;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::RowVector3i f = mesh.F.row(t);
    if (corner_of[f(0)] < 0 || corner_of[f(0)] != corner_of[f(1)] ||
        corner_of[f(0)] != corner_of[f(2)])
      continue;
    const auto length = [&](int k) {
      return (mesh.V.row(f(k)) - mesh.V.row(f((k + 1) % 3))).norm();
    };
    int longest = 0;
    for (int k = 1; k < 3; ++k) longest = length(k) > length(longest) ? k : longest;
    for (int k = 0; k < 3; ++k) {
      const int a = f(k), b = f((k + 1) % 3);
      if (k != longest) within.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return within;
}

/// Those of the edges of one corner that belong to lines whose ends all lie on corners of other
/// views.
std::vector<Edge> whole_lines(const std::vector<Edge>& edges, const std::vector<char>& is_end) {
  std::map<int, std::vector<int>> neighbours;
  for (const auto& [a, b] : edges) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::map<int, bool> is_whole;  // of each vertex's line
  for (const auto& [start, unused] : neighbours) {
    if (is_whole.contains(start)) continue;
    std::vector<int> line{start};
    std::set<int> seen{start};
    bool whole = true;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::vector<int>& next = neighbours.at(line[i]);
      whole = whole && (next.size() == 2 || is_end[line[i]]);
      for (const int v : next)
        if (seen.insert(v).second) line.push_back(v);
    }
    for (const int v : line) is_whole[v] = whole;
  }
  std::vector<Edge> kept;
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(kept),
               [&](const Edge& edge) { return is_whole.at(edge[0]); });
  return kept;
}

}  // namespace

std::vector<DrawnRidge> drawn_ridges(const VisualHull& hull) {
  const double near = 0.02 * hull.spacing;
  std::vector<std::vector<int>> corner_of;
  for (std::size_t v = 0; v < hull.views.size(); ++v) {
    const Outline& outline = hull.views[v].outline;
    const std::vector<double> corners = outline.convex_corners();
    std::vector<int>& of_view = corner_of.emplace_back();
    for (const std::optional<SilhouettePlace>& place : hull.places[v])
      of_view.push_back(corner_at(place, corners, outline.length(), near));
  }
  const EdgeConnectivity edges(hull.mesh.F);
  std::vector<DrawnRidge> ridges;
  std::set<Edge> found;
  for (std::size_t v = 0; v < corner_of.size(); ++v) {
    const std::set<Edge> within = edges_within_corners(hull.mesh, corner_of[v]);
    std::map<int, std::vector<Edge>> of_corner;
    for (const auto& [a, b] : edges.edges()) {
      const Edge edge{std::min(a, b), std::max(a, b)};
      if (corner_of[v][a] >= 0 && corner_of[v][a] == corner_of[v][b] && !within.contains(edge))
        of_corner[corner_of[v][a]].push_back(edge);
    }
    std::vector<char> is_end(hull.mesh.vertex_count(), 0);
    for (std::size_t other = 0; other < corner_of.size(); ++other) {
      for (int i = 0; i < hull.mesh.vertex_count() && other != v; ++i)
        if (corner_of[other][i] >= 0) is_end[i] = 1;
    }
    for (const auto& [corner, of] : of_corner) {
      for (const Edge& edge : whole_lines(of, is_end)) {
        if (found.insert(edge).second) ridges.push_back({edge, static_cast<int>(v)});
      }
    }
  }
  std::sort(ridges.begin(), ridges.end(),
            [](const DrawnRidge& x, const DrawnRidge& y) { return x.edge < y.edge; });
  return ridges;
}

std::vector<Edge> edges_of(const std::vector<DrawnRidge>& ridges) {
  std::vector<Edge> edges;
  for (const DrawnRidge& ridge : ridges) edges.push_back(ridge.edge);
  return edges;
}

}  // namespace geoprior::sketch
