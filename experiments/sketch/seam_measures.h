#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/sketch/scene/scene.h"
#include "testbed/metric_rows.h"

namespace geoprior::sketch {

/// Of the pieces of the last frame one by one: the worst of each.
struct PieceMeasures {
  std::optional<double> stretch_p95;  ///< that 95 % of a piece's area stay under
  std::optional<double> share;        ///< of a piece's area stretched by less than 2 %, the least
  std::optional<double> area_error;   ///< of a piece's flat area from that on the surface
  std::optional<double> refused;      ///< pieces that are refused (piece_verdict.h)
  std::optional<double> least;        ///< area of the smallest over that of all
};
PieceMeasures piece_measures(const SketchScene& scene, const Frame& frame);

/// Turning over length of suggested seams, over that of the drawn silhouettes; nothing where none
/// is suggested or there is no silhouette.
struct SuggestedTurning {
  std::optional<double> in_space;  ///< of those that were cut, else of those that are shown
  std::optional<double> within;    ///< within the surface, of those that were cut
};
SuggestedTurning suggested_turning(const SketchScene& scene, const Frame& frame);

/// Rows of both.
std::vector<MetricGroup> seam_metrics();

}  // namespace geoprior::sketch
