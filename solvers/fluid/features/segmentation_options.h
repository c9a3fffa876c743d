#pragma once

#include <optional>

#include "core/options.h"
#include "solvers/fluid/features/curvature.h"
#include "solvers/fluid/features/masks.h"

namespace geoprior::fluid {

enum class ThresholdKind { automatic, given };

struct SegmentationOptions {
  CurvatureOptions curvature;
  MaskOptions mask;
  /// h, the unit of what follows (m): the scale of the details looked at. Default: the mean edge of
  /// a frame. The same h gives the same regions on a finer mesh: the curvature is then smoothed in
  /// (h / mean edge)^2 times as many passes.
  std::optional<double> cell;
  ThresholdKind thresholds = ThresholdKind::automatic;
  double high = 0.12;
  double low = 0.04;
  double noise_factor = 6;
  double seed_factor = 3;
  double smallest_area = 20;
  double close_radius = 2;
  double open_radius = 1;
  double largest_hole = 100;
  double largest_drop = 0.1;
};
void describe(OptionVisitor& v, SegmentationOptions& options);

}  // namespace geoprior::fluid
