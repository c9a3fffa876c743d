#pragma once

#include <optional>

#include "core/frame.h"
#include "experiments/sketch/scene/scene.h"

namespace geoprior::sketch {

/// Of a reconstruction from drawn arcs, in frames that have it; percentages of the picture's width.
struct ArcMeasures {
  std::optional<double> rms_percent, max_percent;      ///< of drawn points from the arcs' images
  std::optional<double> off_surface_percent;           ///< of the arcs from the surface
  std::optional<double> radius_error, axis_error_deg;  ///< of a known shape: relative; the worst
};
ArcMeasures arc_measures(const SketchScene& scene, const Frame& frame);

/// How layers at rest meet the edges that were drawn, each over the edge's radius; the worst. Of
/// the part "rims": the first arc is the front rim of the first layer, every other the rear rim of
/// one.
struct EdgeMeasures {
  std::optional<double> drawn;  ///< in the view: radius of the ellipse through the stroke alone
  std::optional<double> known;  ///< in space, of a known shape
};
EdgeMeasures edge_measures(const SketchScene& scene, const Frame& frame);

/// Of articulated layers in any pose.
struct LayerMeasures {
  std::optional<double> pairs;          ///< of triangles of different layers that intersect
  std::optional<double> depth_percent;  ///< how deep they do
  std::optional<double> uncovered;      ///< share of rear rims below which no layer is, the worst
  std::optional<double> rivets_off_percent;    ///< of rivets from their own layer
  std::optional<double> rivets_apart_percent;  ///< of the rivets of one layer from the other's line
  std::optional<double> asymmetry_percent;     ///< at rest: Hausdorff distance to its image
};
LayerMeasures layer_measures(const SketchScene& scene, const Frame& frame);

/// Largest relative difference between a stretch of a flat piece's border, from corner to corner,
/// and the same on the surface, both measured as circular arcs; absent without layers or pattern.
std::optional<double> sector_length_error(const SketchScene& scene, const Frame& frame);

}  // namespace geoprior::sketch
