#pragma once

#include <array>
#include <span>
#include <vector>

#include "solvers/fluid/features/regions.h"
#include "solvers/fluid/tracking/options.h"

namespace geoprior::fluid {

/// Speeds (m/s) that regions of a kind hardly exceed: isolated, differential.
using GateSpeeds = std::array<double, 2>;

/// Where a region is heading, as its path tells: position and velocity at its time, with their
/// variances (the same along all axes).
struct RegionMotion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  double position_variance = 0, covariance = 0, velocity_variance = 0;

  /// Variance of the position at dt (s) from the region's time (m^2).
  [[nodiscard]] double variance(double dt) const {
    return position_variance + 2 * dt * covariance + dt * dt * velocity_variance;
  }
};

/// Motions without the link that is being judged: from the regions before on the path, or after.
struct RegionMotions {
  std::vector<RegionMotion> from_past, from_future;
};

/// Variance of a region's centre (m^2): half of (sigma_c h)^2 + sigma_size^2 A, so that a centre
/// and one that tells where it should be differ by all of it.
double centre_variance(const Region& region, double cell, const TrackingOptions& options);

/// Straight line (a parabola under gravity for isolated regions) through region i and up to five
/// others of its path on one side, by least squares; a third of the gate speed is the prior
/// deviation of the velocity. Isolated regions that come with a velocity keep it; differential ones
/// do not, since the water of a wave does not move with the wave.
/// @param next  the way along the path: successors or predecessors, -1 at its end
RegionMotion region_motion(std::span<const Region> regions, std::span<const double> times,
                           double cell, const TrackingOptions& options, const GateSpeeds& speeds,
                           const std::vector<int>& next, std::size_t i);

/// Motions of all regions, each along its path before and after it.
RegionMotions region_motions(std::span<const Region> regions, std::span<const double> times,
                             double cell, const TrackingOptions& options, const GateSpeeds& speeds,
                             const std::vector<int>& successor);

/// Position at dt (s) from the region's time: dt < 0 is before.
Eigen::Vector3d predicted(const Region& region, const RegionMotion& motion, double dt,
                          const TrackingOptions& options);

}  // namespace geoprior::fluid
