#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "metrics/contact/planar_overlap.h"

namespace geoprior {

struct SilhouetteDepthOptions {
  int samples = 1000;   ///< along the drawn outline
  double reach = 0.01;  ///< a sample farther than this from every contour has none, of the
                        ///< diagonal of the drawing's box
  double tail = 0.05;   ///< share of the samples that `range` leaves out at either end
};

/// Where in depth a surface has the outline that a view shows: the curve of the surface whose image
/// is the silhouette (its contour generator).
struct SilhouetteDepth {
  std::vector<std::optional<double>> depth;  ///< of each sample along the view direction (m)
  double range = 0;      ///< of the depths without their tails, over the depth of the whole surface
  double jump = 0;       ///< largest step of depth between neighbouring samples, over the same
  double plane_rms = 0;  ///< root mean square distance of the curve from its best plane, over the
                         ///< diagonal of the drawing's box: 0 for a planar silhouette
};

/// Contour edges are those between a triangle that faces the eye and one that does not, and those
/// of the border. A sample of the drawn outline takes the nearest point of them in the view.
///
/// A sphere's generator is planar, a smooth surface's is connected in space; a silhouette that
/// passes from one part of a surface to another behind it jumps. Where the surface runs along the
/// view direction (the side of an extruded hull) the depth is that of the edge next to the eye, so
/// values of a hull say little. Contours inside of the outline within `reach` of it may be taken
/// for it.
///
/// @param view   as in `projected_points` of metrics/shape/projected_outline.h
/// @param drawn  right and up in the view (m)
/// @throws Error on fewer than three points, options that are not positive, or when no sample has a
///               contour near
SilhouetteDepth silhouette_depth(const TriMesh& mesh, const Eigen::Matrix3d& view,
                                 const PlanarLoop& drawn,
                                 const SilhouetteDepthOptions& options = {});

}  // namespace geoprior
