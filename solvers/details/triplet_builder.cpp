#include "solvers/details/triplet_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/geometry/planar.h"

namespace geoprior::details {

TriangleKeys keys_of(const std::array<double, 3>& edges) {
  std::array<double, 3> e = edges;
  std::sort(e.begin(), e.end());
  const double s = (e[2] + (e[1] + e[0])) * (e[0] - (e[2] - e[1])) * (e[0] + (e[2] - e[1])) *
                   (e[2] + (e[1] - e[0]));
  const double area = 0.25 * std::sqrt(std::max(0.0, s));
  // Opposite to the shortest edge.
  return {area, std::atan2(4 * area, e[1] * e[1] + e[2] * e[2] - e[0] * e[0])};
}

std::array<std::size_t, 3> corners_by_edges(const std::array<double, 3>& edges) {
  std::array<std::size_t, 3> sorted{0, 1, 2};
  std::sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(edges[a], a) < std::pair(edges[b], b);
  });
  // Edge e joins corners e and e + 1; edges a and b meet in a corner.
  const auto meet = [](std::size_t a, std::size_t b) { return b == (a + 1) % 3 ? b : a; };
  return {meet(sorted[2], sorted[0]), meet(sorted[0], sorted[1]), meet(sorted[1], sorted[2])};
}

std::array<int, 2> triplet_cell(const TriangleKeys& keys, double largest_area, int cells) {
  const auto clamped = [&](double x) {
    return std::clamp(static_cast<int>(x * cells), 0, cells - 1);
  };
  return {clamped(std::min(std::sqrt(keys.area / largest_area), 1.0)),
          clamped(keys.least_angle / (std::numbers::pi / 3))};
}

TripletSearch::TripletSearch(const DetailMesh& original, const TripletOptions& options,
                             double mean_edge)
    : original_(original), options_(options) {
  if (options.all) {
    reach_ = std::numeric_limits<double>::infinity();
    for (int t = 0; t < original.mesh.triangle_slots(); ++t)
      if (original.mesh.triangle_alive(t)) largest_area_ += 0.5 * original.mesh.area(t);
  } else {
    reach_ = options.radius * mean_edge;
    largest_area_ = std::sqrt(3.0) / 4 * reach_ * reach_;
  }
}

/// Details strictly inside; false when the triplet does not qualify.
bool TripletSearch::collect_interior(const std::array<std::size_t, 3>& corner,
                                     FoundTriplet& triplet) const {
  constexpr double kInside = 1e-3;  // strictly: not on an edge for round-off
  const Eigen::Vector2d a = points_[corner[0]].at, b = points_[corner[1]].at - a,
                        c = points_[corner[2]].at - a;
  const double inverse = 1 / cross(b, c);
  triplet.interior.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector2d p = points_[i].at - a;
    const double wb = cross(p, c) * inverse, wc = cross(b, p) * inverse, wa = 1 - wb - wc;
    if (wa < kInside || wb < kInside || wc < kInside) continue;  // corners too
    if (std::ssize(triplet.interior) == kMostInside) return false;
    triplet.interior.push_back(
        {points_[i].vertex, {static_cast<float>(wa), static_cast<float>(wb)}});
  }
  return !options_.interior_only || !triplet.interior.empty();
}

void TripletSearch::around(int source, std::vector<FoundTriplet>& into, std::int64_t& met) {
  points_.clear();
  for (const ChartPoint& p : chart_.around(original_.mesh, source, reach_))
    if (original_.is_detail(p.vertex)) points_.push_back(p);
  FoundTriplet triplet;
  for (std::size_t j = 1; j < points_.size(); ++j) {
    if (points_[j].vertex < source) continue;
    for (std::size_t k = j + 1; k < points_.size(); ++k) {
      if (points_[k].vertex < source) continue;
      const double jk = (points_[j].at - points_[k].at).norm();
      if (jk > reach_) continue;
      ++met;
      const std::array<double, 3> edges{points_[j].at.norm(), jk, points_[k].at.norm()};
      const TriangleKeys keys = keys_of(edges);
      const double longest = std::max({edges[0], edges[1], edges[2]});
      if (!(keys.area > 1e-4 * longest * longest)) continue;  // a needle: no query looks like it
      const auto order = corners_by_edges(edges);
      const std::array<std::size_t, 3> ends{0, j, k};
      const std::array<std::size_t, 3> corner{ends[order[0]], ends[order[1]], ends[order[2]]};
      if (!collect_interior(corner, triplet)) continue;
      std::array<double, 3> sorted = edges;
      std::sort(sorted.begin(), sorted.end());
      for (std::size_t c = 0; c < 3; ++c) {
        triplet.corner[c] = points_[corner[c]].vertex;
        triplet.edge[c] = static_cast<float>(sorted[c]);
      }
      triplet.clockwise = cross(points_[corner[1]].at - points_[corner[0]].at,
                                points_[corner[2]].at - points_[corner[0]].at) < 0;
      const auto cell = triplet_cell(keys, largest_area_, options_.cells);
      triplet.cell = cell[0] * options_.cells + cell[1];
      into.push_back(triplet);
    }
  }
}

}  // namespace geoprior::details
