#pragma once

#include <Eigen/Core>
#include <span>

#include "core/mesh.h"
#include "metrics/contact/planar_overlap.h"
#include "metrics/shape/projected_outline.h"

namespace geoprior {

/// Areas of a mesh's projection and of a drawn shape (m^2).
struct SilhouetteArea {
  double mesh = 0, drawn = 0, common = 0;

  /// Intersection over union: 1 for the same shape.
  [[nodiscard]] double iou() const { return common / (mesh + drawn - common); }
};

/// Areas by horizontal lines, one through the middle of each row; along a line the ends of both
/// shapes are exact, so there are no pixels.
///
/// Rows also end at every corner of the drawing and at the mesh's top and bottom, so the drawing's
/// area is exact to round-off. The projection's area is that of the midpoint rule: a corner of its
/// outline errs by at most h^2 / 8 times the change of its slope dx/dy, a horizontal edge of length
/// l away from top, bottom and the drawing's corners by at most l h / 2, h the height of a row.
///
/// @param points     n x 2, of `projected_points` (m)
/// @param triangles  m x 3; edge-on ones have no area
/// @param drawn      closed polygons, of which those inside others are holes (even-odd rule)
/// @param rows       at least 1
/// @throws Error     on a coordinate that is not finite, a polygon of fewer than three points, no
///                   drawn area or none of the projection, or rows below 1
SilhouetteArea silhouette_area(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& triangles,
                               std::span<const PlanarLoop> drawn, int rows = 1024);

struct SilhouetteOptions {
  int rows = 1024;               ///< of `silhouette_area`
  double sampling = 2e-4;        ///< distance of samples, of the diagonal of the drawing's box
  double gap_tolerance = 0.005;  ///< of the same: a drawn point farther than this is not covered
};

/// How well the outline of a mesh in a view follows a drawn one.
struct SilhouetteMatch {
  double iou = 0;
  double hausdorff = 0;          ///< larger of the next two (m)
  double drawn_to_mesh = 0;      ///< largest distance of a drawn point from the mesh's outline (m)
  double mesh_to_drawn = 0;      ///< and the other way (m)
  double hausdorff_percent = 0;  ///< of the diagonal of the drawing's box
  double gap_share = 0;          ///< of the drawn length that is not covered
  double gap_longest = 0;        ///< longest drawn stretch that is not covered (m)
};

/// Distances are those of samples to the exact other outline: the largest is missed by at most half
/// the distance of samples, 1e-4 of the diagonal by default, and never exceeded.
///
/// Only the outline of the whole projection counts: contours inside it, depth, and which part of
/// the mesh makes the outline are not seen, nor that an outline runs to and fro within the
/// tolerance (nearest points need not be in order). Areas hide thin parts: a strap may be missing
/// at an IoU of 0.99, which the distances show.
///
/// @param view    as in `projected_points`
/// @param drawn   right and up in the view (m), as in `silhouette_area`
/// @throws Error  as `projected_points` and `silhouette_area`; on options that are not positive
SilhouetteMatch silhouette_match(const TriMesh& mesh, const Eigen::Matrix3d& view,
                                 std::span<const PlanarLoop> drawn,
                                 const SilhouetteOptions& options = {});

}  // namespace geoprior
