#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solvers/fluid/tracking.h"

namespace geoprior {

/// Velocities of the regions as their paths tell them, without the link that is being judged.
struct RegionMotions {
  std::vector<std::optional<Eigen::Vector3d>> from_past, from_future;  ///< m/s, at the region
};

/// A straight line (a parabola under gravity for isolated regions) through the region and up to
/// three others of its path on one side. Isolated regions that come with a velocity keep it: the
/// surface of a wave does not move with the wave, so others do not.
/// @param successor  of every region, -1 at the end of a path
RegionMotions region_motions(std::span<const Region> regions, std::span<const double> times,
                             const std::vector<int>& successor, const TrackingOptions& options);

/// Where a region will be (dt > 0) or was (m).
Eigen::Vector3d predicted(const Region& region, const Eigen::Vector3d& velocity, double dt,
                          const TrackingOptions& options);

}  // namespace geoprior
