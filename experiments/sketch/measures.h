#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/sketch/scene/scene.h"
#include "metrics/developability/crease_turning.h"
#include "metrics/developability/developability.h"
#include "metrics/isometry/flattening.h"

namespace geoprior::sketch {

/// Of the surface: over all interior vertices, and without those of seams and folds.
struct SurfaceMeasures {
  DevelopabilitySpread all, panels;
  double sharp_turning = 0;  ///< `sharp_turning_share`, without edges along seams and folds
  CreaseMeasures crease;     ///< without edges along seams and folds
  double drawn_length = 0;   ///< of seams and folds, where creases are asked for (m)
};
SurfaceMeasures surface_measures(const SketchScene& scene, const Frame& frame);

/// Of all views the worst.
struct SilhouetteMeasures {
  std::optional<double> iou, hausdorff_percent, gap_share;
};
SilhouetteMeasures silhouette_measures(const SketchScene& scene, const Frame& frame);

/// The pieces of a frame's pattern.
std::vector<FlatPiece> flat_pieces(const Frame& frame);
/// Relative difference of the surface's area from the known one; nothing where none is known.
std::optional<double> surface_area_error(const SketchScene& scene, const Frame& frame);

/// Of the pattern of the last frame; nothing in the others.
struct PatternMeasures {
  std::optional<FlatteningSummary> flat;
  std::optional<double> pieces, piece_overlaps, seam_mismatch;
};
PatternMeasures pattern_measures(const SketchScene& scene, const Frame& frame);

/// Of the cuts that a pattern has and of those that are suggested.
struct CutMeasures {
  std::optional<double> seam_length;  ///< of all cuts, drawn, added and suggested (m)
  std::optional<double> suggestions, suggested_length, first_suggestion_length;
};
CutMeasures cut_measures(const SketchScene& scene, const Frame& frame);

/// Of a reconstruction from one view of a known shape; nothing elsewhere.
struct TruthMeasures {
  std::optional<double> depth_rms, depth_max;  ///< over the height of the shape
  /// Root mean square distance of guessed points of borders from the true ones, over the height.
  std::optional<double> guessed_off;
  std::optional<double> reprojection;  ///< over the width of the drawing
  /// Differences of the flat panels' areas from the true ones over these: of all together, and of
  /// the panel that is farthest off. In frames with a pattern of an object with known panels.
  std::optional<double> pattern_area, panel_area;
  /// Root mean square angle between a ruling and the generator through its middle, of a cone (deg).
  std::optional<double> ruling_angle;
};
TruthMeasures truth_measures(const SketchScene& scene, const Frame& frame);

}  // namespace geoprior::sketch
