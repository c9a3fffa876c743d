#include "metrics/arrangement/lengths.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/error.h"

namespace geoprior {

double out_of_range(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

double attachment_gap(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      double along) {
  return (x - a - along * (b - a)).norm();
}

double distance_from_segment(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& b) {
  const double length = (b - a).squaredNorm();
  const double along = length > 0 ? std::clamp((x - a).dot(b - a) / length, 0.0, 1.0) : 0;
  return attachment_gap(x, a, b, along);
}

std::vector<NeighbourPitch> neighbour_pitches(std::span<const Eigen::Vector3d> points,
                                              std::span<const double> places) {
  if (points.size() != places.size())
    throw Error(
        std::to_string(places.size()) + " places for " + std::to_string(points.size()) + " points",
        "neighbour_pitches", "one each");
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return places[i] < places[j]; });
  std::vector<NeighbourPitch> out;
  for (std::size_t k = 1; k < order.size(); ++k)
    out.push_back({order[k - 1], order[k], (points[order[k]] - points[order[k - 1]]).norm()});
  return out;
}

}  // namespace geoprior
