#include "solvers/fluid/tracking/motion.h"

namespace geoprior::fluid {
namespace {

constexpr int kMostOthers = 5;

Eigen::Vector3d fall(const Region& region, double dt, const TrackingOptions& options) {
  if (region.kind != RegionKind::isolated || !options.ballistic) return Eigen::Vector3d::Zero();
  return 0.5 * dt * dt * Eigen::Vector3d(options.gravity.data());
}

}  // namespace

double centre_variance(const Region& region, double cell, const TrackingOptions& options) {
  const double centre = options.sigma_centre * cell;
  return 0.5 * (centre * centre + options.sigma_size * options.sigma_size * region.area);
}

RegionMotion region_motion(std::span<const Region> regions, std::span<const double> times,
                           double cell, const TrackingOptions& options, const GateSpeeds& speeds,
                           const std::vector<int>& next, std::size_t i) {
  const Region& here = regions[i];
  const double speed = speeds[here.kind == RegionKind::isolated ? 0 : 1];
  RegionMotion motion;
  const double variance = centre_variance(here, cell, options);
  if (here.kind == RegionKind::isolated && here.has_velocity) {
    motion.position = here.centre;
    motion.velocity = here.velocity;
    motion.position_variance = variance;
    return motion;
  }
  // Normal equations of position and velocity, times the variance of a centre.
  double n = 1, t = 0, tt = variance / (speed * speed / 9);
  Eigen::Vector3d sum = here.centre, moment = Eigen::Vector3d::Zero();
  int other = next[i];
  for (int k = 0; k < kMostOthers && other >= 0; ++k) {
    const Region& there = regions[other];
    const double dt = times[there.frame] - times[here.frame];
    const Eigen::Vector3d x = there.centre - fall(here, dt, options);
    n += 1;
    t += dt;
    tt += dt * dt;
    sum += x;
    moment += dt * x;
    other = next[other];
  }
  const double det = n * tt - t * t;
  motion.position = (tt * sum - t * moment) / det;
  motion.velocity = (n * moment - t * sum) / det;
  motion.position_variance = variance * tt / det;
  motion.covariance = -variance * t / det;
  motion.velocity_variance = variance * n / det;
  return motion;
}

RegionMotions region_motions(std::span<const Region> regions, std::span<const double> times,
                             double cell, const TrackingOptions& options, const GateSpeeds& speeds,
                             const std::vector<int>& successor) {
  std::vector<int> predecessor(successor.size(), -1);
  for (int i = 0; i < std::ssize(successor); ++i) {
    if (successor[i] >= 0) predecessor[successor[i]] = i;
  }
  RegionMotions motions;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    motions.from_past.push_back(
        region_motion(regions, times, cell, options, speeds, predecessor, i));
    motions.from_future.push_back(
        region_motion(regions, times, cell, options, speeds, successor, i));
  }
  return motions;
}

Eigen::Vector3d predicted(const Region& region, const RegionMotion& motion, double dt,
                          const TrackingOptions& options) {
  return motion.position + dt * motion.velocity + fall(region, dt, options);
}

}  // namespace geoprior::fluid
