#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/inputs/surface_sequence.h"
#include "solvers/fluid/feature.h"
#include "solvers/fluid/features/segmentation.h"
#include "solvers/fluid/tracking/tracking.h"

namespace geoprior::fluid {

/// Space-time features of any surface animation. Thesis 3.3.1.
struct ExtractionOptions {
  SegmentationOptions segmentation;
  TrackingOptions tracking;
  MapOptions map;
  int shortest_track = 3;
};
void describe(OptionVisitor& v, ExtractionOptions& options);

/// Labels of the vertices of every frame and the tracks that join them.
struct Extraction {
  double cell = 0;  ///< h (m)
  Thresholds thresholds;
  std::shared_ptr<const Segmenter> segmenter;  ///< labels any frame again, exactly as it did
  std::vector<double> times;
  std::vector<Region> regions;  ///< of all frames, ordered by frame
  TrackResult tracking;
  std::vector<std::string> warnings;  ///< naming frame and what was done
};

/// Segments every frame and tracks the regions. Calls `each` for every frame as it is segmented.
/// Phases: "segment", "track".
Extraction extract_regions(
    const SurfaceSequence& sequence, const ExtractionOptions& options, RunContext& context,
    const std::function<void(int, const SurfaceFrame&, const SegmentedFrame&)>& each = {});

/// Lifts tracks out of the animation (all of them when `ids` is empty): base surface, maps, moving
/// frames. Phase "lift". @throws Error  for an id that does not exist (names those that do)
std::vector<Feature> lift_features(const SurfaceSequence& sequence, const Extraction& extraction,
                                   const ExtractionOptions& options, const std::vector<int>& ids,
                                   RunContext& context);

/// The animation without a feature: its bed is put back under a differential one, an isolated one
/// is removed. In a frame that a wave's track misses, though it goes on later, the bed is made
/// where the frames before and after have it: its map is interpolated there too.
SurfaceFrame without_feature(const SurfaceFrame& frame, int frame_index,
                             const Extraction& extraction, const ExtractionOptions& options,
                             const std::vector<int>& ids);

}  // namespace geoprior::fluid
