#pragma once

#include <optional>
#include <vector>

#include "core/frame.h"
#include "experiments/sketch/scene/scene.h"
#include "testbed/metric_rows.h"

namespace geoprior::sketch {

/// Triangles beside the edges of drawn folds, and the angle that each stroke asks for (60 degrees
/// where it says none, as the thesis has it).
struct FoldMeasures {
  std::optional<double> mean_deg, max_deg;
};
FoldMeasures fold_measures(const SketchScene& scene, const Frame& frame);

/// How far vertices of drawn borders and seams are from their strokes, in the view of the stroke.
struct StrokeMeasures {
  std::optional<double> off_percent;  ///< largest distance, of the diagonal of the view's drawing
};
StrokeMeasures stroke_measures(const SketchScene& scene, const Frame& frame);

/// Of the first view's silhouette on the surface, in the last frame (`SilhouetteDepth`).
struct GeneratorMeasures {
  std::optional<double> range, jump, plane_percent;
};
GeneratorMeasures generator_measures(const SketchScene& scene, const Frame& frame);

/// Of the pieces of the last frame: normals of each about a circle (`GaussImage`), means by area.
struct GaussMeasures {
  std::optional<double> great, small, rms_deg;
};
GaussMeasures gauss_measures(const SketchScene& scene, const Frame& frame);

/// Of the seams of the last frame, point by point.
struct SeamPointMeasures {
  std::optional<double> shift_percent;  ///< largest shift of a point from its partner, of the seam
  std::optional<double> segment;        ///< largest relative difference of two sewn segments
};
SeamPointMeasures seam_point_measures(const SketchScene& scene, const Frame& frame);

/// Distance of the last frame's surface from its image in the plane x = 0, the middle of the front.
std::optional<double> mirror_percent(const SketchScene& scene, const Frame& frame);

/// Rows of all of these.
std::vector<MetricGroup> garment_metrics();

}  // namespace geoprior::sketch
