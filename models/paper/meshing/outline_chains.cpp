#include "models/paper/meshing/outline_chains.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/paper/contact/segments.h"

namespace geoprior::paper {

using Eigen::Vector2d;

namespace {

struct OnBorder {
  int edge;
  double t;
  int vertex;
  bool operator<(const OnBorder& other) const {
    return std::pair(edge, t) < std::pair(other.edge, other.t);
  }
};

}  // namespace

std::vector<int> points_along(const std::vector<Vector2d>& points, const Vector2d& a,
                              const Vector2d& b, double tolerance) {
  std::vector<std::pair<double, int>> along;
  const Vector2d d = (b - a).normalized();
  for (int i = 0; i < std::ssize(points); ++i) {
    if (distance_to_segment(points[i], a, b) <= tolerance) {
      along.emplace_back((points[i] - a).dot(d), i);
    }
  }
  std::sort(along.begin(), along.end());
  std::vector<int> path;
  for (const auto& [t, i] : along) path.push_back(i);
  return path;
}

std::vector<std::vector<int>> border_chains(const Pattern& pattern, double longest,
                                            double tolerance, PointSet& set) {
  const std::vector<Vector2d> all = corners(pattern);
  std::vector<OnBorder> on_border;
  const std::vector<Vector2d> points = set.points();
  for (int i = 0; i < std::ssize(points); ++i) {
    const BorderPoint near = nearest_on_loops(pattern, points[i]);
    if (near.distance > tolerance) continue;
    // A corner is both the end of one edge and the start of the next: count it once, as the start.
    const int next = next_edge(pattern, near.edge);
    const bool at_end = (points[i] - all[next]).norm() <= tolerance;
    on_border.push_back({at_end ? next : near.edge, at_end ? 0 : near.t, i});
  }
  std::sort(on_border.begin(), on_border.end());
  std::vector<std::vector<int>> chains;
  int end_edge = 0;
  for (std::size_t k = 0, i = 0; k < pattern.loop_count(); ++k) {
    end_edge += static_cast<int>(pattern.loop(k).size());
    const std::size_t first = i;
    std::vector<int>& chain = chains.emplace_back();
    for (; i < on_border.size() && on_border[i].edge < end_edge; ++i) {
      const bool last = i + 1 == on_border.size() || on_border[i + 1].edge >= end_edge;
      const int from = on_border[i].vertex;
      const int to = on_border[last ? first : i + 1].vertex;
      chain.push_back(from);
      const Vector2d a = points[from];
      const Vector2d b = points[to];
      const int parts = static_cast<int>(std::ceil((b - a).norm() / longest - 1e-9));
      for (int part = 1; part < parts; ++part) chain.push_back(set.add(a + (b - a) * part / parts));
    }
  }
  return chains;
}

std::vector<Eigen::Vector2i> cut_segments(const Pattern& pattern, double longest, double tolerance,
                                          PointSet& set) {
  std::vector<Eigen::Vector2i> segments;
  for (const std::vector<Vector2d>& cut : pattern.cuts) {
    for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
      const std::vector<int> path = points_along(set.points(), cut[i], cut[i + 1], tolerance);
      for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        const Vector2d a = set.points()[path[k]], b = set.points()[path[k + 1]];
        const int parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / longest - 1e-9)));
        int last = path[k];
        for (int part = 1; part <= parts; ++part) {
          const int here = part == parts ? path[k + 1] : set.add(a + (b - a) * part / parts);
          segments.emplace_back(last, here);
          last = here;
        }
      }
    }
  }
  return segments;
}

}  // namespace geoprior::paper
