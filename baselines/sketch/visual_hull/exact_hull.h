#pragma once

#include "models/sketch/surface/visual_hull.h"

namespace geoprior::sketch {

/// The visual hull by the slow road: every silhouette extruded along its view to a solid, the
/// solids intersected exactly, the result remeshed to equal edges. To compare with `visual_hull`,
/// whose triangles it aims at the number of.
///
/// Predicates are exact, constructed points are rounded. The creases between the views' faces are
/// found by their angle, split to the wanted length and kept as curves by the remeshing, so the
/// silhouettes are those of the drawing up to chords.
///
/// @param aligned  of `align_views`: at least two views that are not `photo`
/// @throws Error   with fewer views; when the intersection is no solid
/// Source: CGAL 5.5, Polygon Mesh Processing (corefinement, isotropic remeshing after Botsch and
/// Kobbelt 2004a).
VisualHull exact_hull(const Drawing& aligned, const HullOptions& hull);

}  // namespace geoprior::sketch
