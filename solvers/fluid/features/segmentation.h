#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "core/options.h"
#include "solvers/fluid/features/curvature.h"
#include "solvers/fluid/features/regions.h"
#include "solvers/fluid/paste/masks.h"

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

/// A frame with every vertex labelled: 0 bed, 1 … region.
struct SegmentedFrame {
  Eigen::VectorXd curvature;  ///< H (1/m)
  std::vector<int> label;
  std::vector<char> masked;
  std::vector<Region> regions;
  std::vector<std::string> warnings;  ///< "inward oriented: turned over", "empty", …
};

struct Thresholds {
  double high = 0.12, low = 0.04;
};

/// Walls and thresholds that a whole sequence decides; made once, then every frame is on its own.
///
/// A frame's regions: |H| h above `high` seeds them, above `low` grows them; then closing, opening,
/// holes, smallest area. Small closed components are isolated regions, whole and whatever their
/// curvature. Masked vertices and borders are in no region and bound no morphology.
class Segmenter {
 public:
  /// Looks at up to 16 frames. @throws Error  when all frames are empty
  Segmenter(const SurfaceSequence& sequence, const SegmentationOptions& options);
  /// Equal bytes for any thread count. @throws Error  on vertices that are not finite (named)
  [[nodiscard]] SegmentedFrame segment(const SurfaceFrame& frame, int frame_index) const;
  [[nodiscard]] const Thresholds& thresholds() const { return thresholds_; }
  [[nodiscard]] double cell() const { return cell_; }
  [[nodiscard]] const Walls& walls() const { return walls_; }
  /// "no frame is calm: …": what the thresholds rest on when it is not the calm frames.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  SegmentationOptions options_;
  Thresholds thresholds_;
  double cell_ = 0;
  CurvatureOptions curvature_;  ///< with the passes that the cell asks for
  Walls walls_;
  std::vector<std::string> warnings_;
};

}  // namespace geoprior::fluid
