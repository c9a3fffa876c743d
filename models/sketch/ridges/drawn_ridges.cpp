#include "models/sketch/ridges/drawn_ridges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

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
  for (const auto& [a, b] : edges.edges()) {
    const auto of_view =
        std::find_if(corner_of.begin(), corner_of.end(),
                     [a = a, b = b](const auto& of) { return of[a] >= 0 && of[a] == of[b]; });
    if (of_view == corner_of.end()) continue;
    ridges.push_back(
        {{std::min(a, b), std::max(a, b)}, static_cast<int>(of_view - corner_of.begin())});
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
