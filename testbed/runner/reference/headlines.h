#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// A metric as one number of each variant: what has a reference value.
struct Headline {
  std::string metric;
  bool of_sequence = false;         ///< one value for all frames: neither of the next two is read
  std::optional<double> at;         ///< at the frame of this parameter
  Reduction over = Reduction::max;  ///< else over the frames; never `every`

  /// "overlap_excess.max", "outer_bulge@90", "events" of a sequence.
  [[nodiscard]] std::string name() const;
};

/// What the claims of an experiment read, as they read it (their studies, the quantity), and those
/// metrics of its figure and of `[check]` that no claim reads, at their worst (on either side of a
/// target). A claim at every frame reads the worst frame. Times and diagnostics are none; nor are
/// rows that the metric table leaves `ungated`.
std::vector<Headline> headlines(const Experiment& experiment, const Topic& topic);

/// The number of a variant: NaN where the metric has none (no such frame, no value there); absent
/// where the variant was not measured so.
std::optional<double> headline_value(const CaseRecord& in, const VariantRecord& variant,
                                     const Headline& headline);

/// "outer_bulge" of "outer_bulge@90", "overlap_volume" of "overlap_volume.max"; names with a prefix
/// ("diagnostic:iterations") are whole.
std::string without_statistic(const std::string& name);

}  // namespace geoprior
