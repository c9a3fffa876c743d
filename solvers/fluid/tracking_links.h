#pragma once

#include <array>
#include <span>
#include <vector>

#include "solvers/fluid/tracking_motion.h"

namespace geoprior {

/// Speeds (m/s) beyond which regions of a kind are not linked while their motion is unknown:
/// isolated, differential.
using GateSpeeds = std::array<double, 2>;

/// The option, or one and a half times the speed that nine in ten regions need to be the nearest
/// region of their kind and size in the next frame; at least four cells a frame.
GateSpeeds gate_speeds(std::span<const Region> regions, std::span<const double> times, double cell,
                       const TrackingOptions& options);

/// Links between regions of one kind, up to `largest_gap` frames apart, with their costs
///   |c_j - prediction|^2 / s^2 + 6 ln(s / s_known) + ln(A_j / A_i)^2 / sigma_A^2
///     + ln(V_j / V_i)^2 / sigma_V^2 + (g - 1) gap_cost,
/// s_known^2 = g (sigma_c h)^2 + sigma_size^2 A. Where motions are known, s = s_known and the first
/// term is the mean of the errors of the prediction forwards from i and backwards from j; else the
/// prediction is to stay, and s^2 grows by a third of the way that the gate speed allows, squared.
/// Links that cost more than a new path are left out.
std::vector<PathLink> candidate_links(std::span<const Region> regions,
                                      std::span<const double> times, double cell,
                                      const TrackingOptions& options, const RegionMotions& motions,
                                      const GateSpeeds& speeds);

}  // namespace geoprior
