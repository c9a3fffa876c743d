#pragma once

#include <functional>
#include <vector>

#include "solvers/fluid/edits.h"
#include "solvers/fluid/extraction.h"
#include "solvers/fluid/lift/patch.h"

namespace geoprior::fluid {

/// Labels of a frame: what its segmentation said when the tracks were made. Called from several
/// threads.
using Labeller = std::function<FrameLabels(const SurfaceFrame& frame, int index)>;

/// `lift_features` for any labelling, and without what it does not need: for regions that were
/// marked by other means.
std::vector<Feature> lift_tracks(const SurfaceSequence& sequence, const Extraction& extraction,
                                 const Labeller& labeller, const MapOptions& options,
                                 const std::vector<int>& ids, RunContext& context);

/// `without_feature` for any labelling. @param labels  of regions to be taken out
/// @param border  width around them that the bed may change (m)
SurfaceFrame without_regions(const SurfaceFrame& frame, const FrameLabels& labels,
                             const std::vector<Region>& regions, double border);

/// Id, times, centres and areas of the tracks: what an edit selects from. Only those of at least
/// `shortest` frames.
std::vector<FeatureSummary> track_summaries(const Extraction& extraction, int shortest);

}  // namespace geoprior::fluid
