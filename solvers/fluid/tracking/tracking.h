#pragma once

#include <vector>

#include "solvers/fluid/features/regions.h"
#include "solvers/fluid/tracking/options.h"
#include "solvers/fluid/tracking/path_cover.h"
#include "solvers/fluid/tracking/track.h"

namespace geoprior::fluid {

struct TrackResult {
  std::vector<Track> tracks;
  std::vector<TrackEvent> events;  ///< the causality graph's edges
  std::vector<PathLink> links;     ///< candidates that were considered
};

/// @param regions  of all frames, ordered by frame; @param times of the frames (s); @param cell h
/// (m)
TrackResult track_regions(const std::vector<Region>& regions, const std::vector<double>& times,
                          double cell, const TrackingOptions& options);

}  // namespace geoprior::fluid
