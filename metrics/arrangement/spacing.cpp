#include "metrics/arrangement/spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.h"
#include "metrics/arrangement/point_grid.h"

namespace geoprior {
namespace {

void require_extents(std::size_t points, std::span<const double> extents) {
  if (points != extents.size())
    throw Error(
        std::to_string(extents.size()) + " extents for " + std::to_string(points) + " points",
        "check_spacing", "one each");
  for (std::size_t i = 0; i < extents.size(); ++i)
    if (!(extents[i] >= 0) || !std::isfinite(extents[i]))
      throw Error("the extent is negative or not finite", "point " + std::to_string(i), ">= 0 m");
}

}  // namespace

SpacingCheck check_spacing(std::span<const Eigen::Vector3d> points, std::span<const double> extents,
                           double tolerance) {
  require_extents(points.size(), extents);
  std::vector<Eigen::Vector3d> seen;
  std::vector<double> extent;
  std::vector<int> number;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (extents[i] == 0) continue;
    seen.push_back(points[i]);
    extent.push_back(extents[i]);
    number.push_back(static_cast<int>(i));
  }
  SpacingCheck out;
  if (seen.size() < 2) return out;
  const double widest = *std::max_element(extent.begin(), extent.end());
  const PointGrid grid(std::move(seen));
  // The nearest neighbours bound the smallest ratio; then all pairs that could be under it.
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < grid.size(); ++i) {
    const PointGrid::Nearest near = grid.nearest(grid.point(i), i);
    smallest = std::min(smallest, near.distance / (extent[i] + extent[near.point]));
  }
  for (int i = 0; i < grid.size(); ++i) {
    const double reach = std::max(1.0, smallest) * (extent[i] + widest);
    grid.visit(grid.point(i), reach, [&](int j, double distance) {
      if (j <= i) return;
      const double sum = extent[i] + extent[j];
      smallest = std::min(smallest, distance / sum);
      if (distance < sum - tolerance) out.too_close.emplace_back(number[i], number[j]);
    });
  }
  out.smallest_ratio = smallest;
  return out;
}

std::vector<double> nearest_neighbour_distances(std::span<const Eigen::Vector3d> points) {
  std::vector<double> out;
  if (points.size() < 2) return out;
  const PointGrid grid({points.begin(), points.end()});
  for (int i = 0; i < grid.size(); ++i) out.push_back(grid.nearest(grid.point(i), i).distance);
  return out;
}

std::optional<double> coefficient_of_variation(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  if (mean == 0) return std::nullopt;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / count) / mean;
}

std::optional<double> largest_hole(std::span<const Eigen::Vector3d> places,
                                   std::span<const Eigen::Vector3d> points) {
  if (places.empty() || points.empty()) return std::nullopt;
  const PointGrid grid({points.begin(), points.end()});
  double out = 0;
  for (const Eigen::Vector3d& x : places) out = std::max(out, grid.nearest(x).distance);
  return out;
}

}  // namespace geoprior
