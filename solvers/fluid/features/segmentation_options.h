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
  double high = 0.12;  ///< seeds: |H| h above this (given)
  double low = 0.04;   ///< grown through |H| h above this (given)
  /// Automatic: low = median + this * MAD of |H| h over the free surface of the calm frames.
  double noise_factor = 6;
  double seed_factor = 3;     ///< automatic: high = this * low
  double smallest_area = 20;  ///< regions below this many h^2 are dropped
  double close_radius = 2;    ///< dilation then erosion (h)
  double open_radius = 1;     ///< erosion then dilation (h)
  double largest_hole = 100;  ///< holes of a region up to this many h^2 are filled
  double largest_drop = 0.1;  ///< isolated: volume at most this share of the largest component's
  bool handles = true;        ///< isolated components may have handles (torn crowns)
};
void describe(OptionVisitor& v, SegmentationOptions& options);

}  // namespace geoprior::fluid
