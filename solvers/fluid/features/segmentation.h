#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/inputs/surface_sequence.h"
#include "solvers/fluid/features/regions.h"
#include "solvers/fluid/features/segmentation_options.h"
#include "solvers/fluid/features/segmentation_thresholds.h"

namespace geoprior::fluid {

/// A frame with every vertex labelled: 0 bed, 1 … region.
struct SegmentedFrame {
  Eigen::VectorXd curvature;  ///< H (1/m)
  std::vector<int> label;
  std::vector<char> masked;
  std::vector<Region> regions;
  std::vector<std::string> warnings;  ///< "inward oriented: turned over", "empty", …
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
