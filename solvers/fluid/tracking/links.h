#pragma once

#include <span>
#include <vector>

#include "solvers/fluid/tracking/motion.h"
#include "solvers/fluid/tracking/path_cover.h"

namespace geoprior::fluid {

/// One and a half times the speed of nine in ten pairs of regions of successive frames that are
/// each other's nearest of their kind and about their size; at least four cells a frame.
GateSpeeds gate_speeds(std::span<const Region> regions, std::span<const double> times, double cell,
                       const TrackingOptions& options);

/// First paths, frame after frame: the best assignment of its regions to the paths that are open,
/// by the costs below looking forwards only. What a path has done tells where it goes on, which is
/// how drops that pass each other are told apart.
/// @return  successor of every region, -1 at the end of a path
std::vector<int> first_paths(std::span<const Region> regions, std::span<const double> times,
                             double cell, const TrackingOptions& options, const GateSpeeds& speeds);

/// Links between regions of one kind, up to `largest_gap` frames apart, with their costs
///   mean of |c - prediction|^2 / s^2 + 6 ln(s / s_1)   forwards from i and backwards from j
///     + ln(A_j / A_i)^2 / sigma_A^2 + ln(V_j / V_i)^2 / sigma_V^2 + (g - 1) gap_cost,
/// s^2 = g s_1^2 / 2 + the prediction's variance, s_1^2 = (sigma_c h)^2 + sigma_size^2 A: twice the
/// negative logarithm of a likelihood, whose second part counts for c_new / 2 at most, so that
/// motions that are not known yet do not forbid links. Links that cost more than a new path are
/// left out, and those faster than `largest_speed` when that is given.
std::vector<PathLink> candidate_links(std::span<const Region> regions,
                                      std::span<const double> times, double cell,
                                      const TrackingOptions& options, const RegionMotions& motions);

}  // namespace geoprior::fluid
