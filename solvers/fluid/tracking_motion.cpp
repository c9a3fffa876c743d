#include "solvers/fluid/tracking_motion.h"

namespace geoprior {
namespace {

constexpr int kMostOthers = 3;

Eigen::Vector3d fall(const Region& region, double dt, const TrackingOptions& options) {
  if (region.kind != RegionKind::isolated || !options.ballistic) return Eigen::Vector3d::Zero();
  return 0.5 * dt * dt * Eigen::Vector3d(options.gravity.data());
}

/// @param next  the way along the path: successors or predecessors
std::optional<Eigen::Vector3d> fitted_velocity(std::span<const Region> regions,
                                               std::span<const double> times, std::size_t i,
                                               const std::vector<int>& next,
                                               const TrackingOptions& options) {
  const Region& here = regions[i];
  if (here.kind == RegionKind::isolated && here.has_velocity) return here.velocity;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double weight = 0;
  int other = next[i];
  for (int k = 0; k < kMostOthers && other >= 0; ++k) {
    const Region& there = regions[static_cast<std::size_t>(other)];
    const double dt =
        times[static_cast<std::size_t>(there.frame)] - times[static_cast<std::size_t>(here.frame)];
    moment += dt * (there.centre - here.centre - fall(here, dt, options));
    weight += dt * dt;
    other = next[static_cast<std::size_t>(other)];
  }
  if (weight <= 0) return std::nullopt;
  return moment / weight;
}

}  // namespace

RegionMotions region_motions(std::span<const Region> regions, std::span<const double> times,
                             const std::vector<int>& successor, const TrackingOptions& options) {
  std::vector<int> predecessor(successor.size(), -1);
  for (std::size_t i = 0; i < successor.size(); ++i) {
    if (successor[i] >= 0)
      predecessor[static_cast<std::size_t>(successor[i])] = static_cast<int>(i);
  }
  RegionMotions motions;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    motions.from_past.push_back(fitted_velocity(regions, times, i, predecessor, options));
    motions.from_future.push_back(fitted_velocity(regions, times, i, successor, options));
  }
  return motions;
}

Eigen::Vector3d predicted(const Region& region, const Eigen::Vector3d& velocity, double dt,
                          const TrackingOptions& options) {
  return region.centre + dt * velocity + fall(region, dt, options);
}

}  // namespace geoprior
