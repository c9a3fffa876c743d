#pragma once

#include <vector>

#include "solvers/fluid/features/regions.h"

namespace geoprior::fluid {

/// A space-time feature: regions of increasing frames (indices into the list given), gaps allowed.
struct Track {
  int id = 0;  ///< 1 …, by first frame, then label
  RegionKind kind = RegionKind::differential;
  std::vector<int> regions;
};

enum class TrackEventKind { split, merge, causes };
/// "causes": an isolated feature ends where a differential one begins within a short time.
struct TrackEvent {
  TrackEventKind kind = TrackEventKind::split;
  int frame = 0;
  int from = 0, to = 0;  ///< track ids
};

}  // namespace geoprior::fluid
