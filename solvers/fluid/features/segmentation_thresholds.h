#pragma once

#include <span>
#include <string>
#include <vector>

#include "solvers/fluid/features/segmentation_options.h"

namespace geoprior::fluid {

/// On |H| h: a region grows from vertices above `high` through those above `low`.
struct Thresholds {
  double high = 0.12, low = 0.04;
};

/// Thresholds on s = |H| h from samples of the free surface, frame by frame.
///
/// Calm frames: those whose 90th percentile of s is at most twice the calmest one's, provided that
/// this is at most 0.06. Then low = median + noise_factor * MAD of their samples. When no frame is
/// calm (an ocean, a boat always under way at high resolution), high = Otsu's threshold of ln s
/// over all samples and low = high / seed_factor, with a warning.
///
/// @param floor  least value of low: h over the radius of curvature that counts as flat (a quarter
/// of the scene's diagonal); a flat surface without noise would give 0
Thresholds automatic_thresholds(std::span<const std::vector<float>> frames, double floor,
                                const SegmentationOptions& options,
                                std::vector<std::string>& warnings);

}  // namespace geoprior::fluid
