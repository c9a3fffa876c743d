#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "experiments/sketch/truth/known_object.h"
#include "experiments/sketch/truth/synthetic_views.h"
#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// Where a known object lies on the page that it is drawn on: q = frame p + (shift, 0), in true
/// size, so that the lower left corner of the page is the origin.
struct KnownPlacement {
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< rows: right, up, towards the eye
  Eigen::Vector3d shift{0, 0, 0};                       ///< m; z = 0
  Eigen::Vector2d page{1, 1};                           ///< width and height (m)

  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    return frame * p + shift;
  }
};
KnownPlacement known_placement(const KnownObject& object);

/// All panels in the view, one after another.
struct PlacedPanels {
  TriMesh mesh;
  std::vector<int> panel;  ///< of each triangle
};
PlacedPanels placed_panels(const KnownObject& object, const KnownPlacement& placement);

/// Orthographic drawing of an object as a careful user makes it over its photograph:
///
/// - borders whole, hidden parts too, which strokes of kind occlusion mark;
/// - of every ruled panel the silhouettes that are seen: rulings along which the normal is
///   orthogonal to the view; where there is none, one ruling that is seen;
/// - the object's pairs (points of the mirror plane as ticks along its normal), and the two vectors
///   of the mirror plane.
///
/// With `visible_only` as the thesis has it, nothing that is hidden is drawn: of every border the
/// stretches that are seen, each a stroke of its own, up to where something begins to cover them
/// ("bottom", "bottom-2", ...), of the pairs those both of whose ends are seen, and no occlusion.
/// Silhouettes that are seen in their middle are drawn to both borders, with a ruler.
///
/// Every stroke has its true place in space, every panel its true area.
SyntheticView known_view(const KnownObject& object, bool visible_only = false);

/// Moves every drawn point by normal noise. Each stroke has random numbers of its own; a tick moves
/// as a whole, ends of borders that meet move together (drawing programs snap them), and plane
/// vectors stay unless they are noisy too.
/// @param spread  standard deviation of either coordinate (m)
void add_drawing_noise(View& view, double spread, std::uint64_t seed, bool noisy_vectors = false);

}  // namespace geoprior::sketch
