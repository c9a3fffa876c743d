#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "core/options.h"
#include "models/sketch/drawing/drawing.h"
#include "models/sketch/drawing/outlined_view.h"
#include "models/sketch/sections/section_report.h"

namespace geoprior::sketch {

struct HullOptions {
  int triangles = 8000;
  HullSections sections = HullSections::automatic;
  bool ridges = true;  ///< edges are flipped to run along them
};
void describe(OptionVisitor& v, HullOptions& options);

/// Where a vertex of the hull lies on a view's silhouette.
struct SilhouettePlace {
  double arc_length = 0;         ///< m
  Eigen::Vector2d normal{0, 0};  ///< outward, in the view
};

/// All points that every view sees inside of its silhouette, meshed: closed, a manifold.
struct VisualHull {
  TriMesh mesh;
  std::vector<OutlinedView> views;
  /// A row a view: where each vertex lies on its silhouette; nothing for vertices that do not.
  std::vector<std::vector<std::optional<SilhouettePlace>>> places;
  double spacing = 0;  ///< of the grid that it was meshed on: about the length of an edge (m)
  SectionReport sections;
};

/// The hull as the zero set of max over the views of their signed distances, by surface nets, then
/// moved onto the silhouettes exactly: a vertex goes to every silhouette that the surface is on in
/// its cell, and to the corner where it is on both sides of one, so that edges between faces are
/// sharp.
///
/// Its error against the drawing is that of chords of the length of an edge.
///
/// Nothing of a drawing says how wide a hat's crown is seen from above, where the brim hides it:
/// the hull of the views is a box there. What sections are instead is `SectionBounds`'s to decide.
/// @param aligned  of `align_views`: at least two views that are not `photo`
/// @throws Error   with fewer views; when the views have no point in common; when parts are thinner
///                 than the grid; on sections `top` without all three views
/// Source of the construction: Rivers, Durand and Igarashi 2010, 3D Modeling with Silhouettes.
VisualHull visual_hull(const Drawing& aligned, const HullOptions& options = {});

/// Finds the vertices that lie on each view's silhouette, to a fiftieth of the spacing.
void place_on_silhouettes(VisualHull& hull);

}  // namespace geoprior::sketch
