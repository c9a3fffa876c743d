#include "metrics/arrangement/changes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "metrics/arrangement/lengths.h"

namespace geoprior {
namespace {

void require_as_many(std::size_t count, std::size_t other, const char* where) {
  if (count != other)
    throw Error(std::to_string(other) + " points after " + std::to_string(count), where, "as many");
}

}  // namespace

double extent_of(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) return 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : points) mean += x;
  mean /= static_cast<double>(points.size());
  double farthest = 0;
  for (const Eigen::Vector3d& x : points) farthest = std::max(farthest, (x - mean).norm());
  return 2 * farthest;
}

double distance_change(std::span<const Eigen::Vector3d> before,
                       std::span<const Eigen::Vector3d> after) {
  require_as_many(before.size(), after.size(), "distance_change");
  double out = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      out = std::max(out, std::abs((after[i] - after[j]).norm() - (before[i] - before[j]).norm()));
  return out;
}

double unexplained_displacement(std::span<const Eigen::Vector3d> before,
                                std::span<const Eigen::Vector3d> after,
                                std::span<const Eigen::Vector3d> asked_before,
                                std::span<const Eigen::Vector3d> asked_after) {
  for (const std::size_t other : {after.size(), asked_before.size(), asked_after.size()})
    require_as_many(before.size(), other, "unexplained_displacement");
  double out = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    out = std::max(out, distance_from_segment(after[i] - before[i], Eigen::Vector3d::Zero(),
                                              asked_after[i] - asked_before[i]));
  return out;
}

}  // namespace geoprior
