#include "solvers/sketch/surface/zippering.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace geoprior::sketch {

Zippering::Zippering(const OutlinedView& view, std::vector<std::optional<SilhouettePlace>> places,
                     const std::vector<Edge>& edges, SilhouetteChoice choice)
    : view_(view), places_(std::move(places)), choice_(choice) {
  const double length = view_.outline.length();
  for (const Edge& edge : edges) {
    const auto& a = places_[edge[0]];
    const auto& b = places_[edge[1]];
    if (!a || !b || a->arc_length == b->arc_length) continue;
    double from = std::min(a->arc_length, b->arc_length);
    double to = std::max(a->arc_length, b->arc_length);
    if (to - from > length / 2) {  // the shorter way passes the first point
      from = std::exchange(to, from + length);
    }
    intervals_.push_back({from, to, edge});
    longest_ = std::max(longest_, to - from);
  }
  std::sort(intervals_.begin(), intervals_.end(), [](const Interval& a, const Interval& b) {
    return a.from != b.from ? a.from < b.from : a.edge < b.edge;
  });
}

double Zippering::merit(const Edge& edge, const Eigen::MatrixX3d& hull,
                        const Eigen::MatrixX3d& surface, double middle) const {
  double sum = 0;
  for (const int v : edge) {
    if (choice_ == SilhouetteChoice::planar) {
      sum -= std::abs(view_.frame.row(2).dot(hull.row(v)) - middle);
      continue;
    }
    const Eigen::Vector3d way = (surface.row(v) - hull.row(v)).transpose();
    sum += places_[v]->normal.dot(view_.project(way));
  }
  return sum / 2;
}

ZippedSilhouette Zippering::close(const Eigen::MatrixX3d& hull,
                                  const Eigen::MatrixX3d& surface) const {
  ZippedSilhouette zipped;
  if (intervals_.empty()) {
    zipped.gaps.push_back({0, view_.outline.length()});
    return zipped;
  }
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  for (const Interval& interval : intervals_) {
    for (const int v : interval.edge) {
      nearest = std::min(nearest, view_.frame.row(2).dot(hull.row(v)));
      farthest = std::max(farthest, view_.frame.row(2).dot(hull.row(v)));
    }
  }
  const double middle = (nearest + farthest) / 2;
  const double start = intervals_.front().from, end = start + view_.outline.length();
  double reached = start;
  while (reached < end) {
    const auto after = std::upper_bound(
        intervals_.begin(), intervals_.end(), reached,
        [](double value, const Interval& interval) { return value < interval.from; });
    const Interval* best = nullptr;
    double most = -std::numeric_limits<double>::infinity();
    for (auto i = after; i != intervals_.begin() && reached - (i - 1)->from < longest_; --i) {
      const Interval& candidate = *(i - 1);
      if (candidate.to <= reached) continue;
      const double p = merit(candidate.edge, hull, surface, middle);
      if (p > most) {
        most = p;
        best = &candidate;
      }
    }
    if (best != nullptr) {
      zipped.edges.push_back(best->edge);
      reached = best->to;
      continue;
    }
    const double next = after == intervals_.end() ? end : after->from;
    zipped.gaps.push_back({reached, next});
    reached = next;
  }
  return zipped;
}

}  // namespace geoprior::sketch
