#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// A straight piece of a curve in the plane (m).
struct PlanarSegment {
  Eigen::Vector2d a, b;
};

/// Vertices of a mesh in an orthographic view: right and up (m).
///
/// @param view  rows: unit vectors to the right, up and towards the eye, orthogonal
/// @throws Error  when the rows are not orthonormal (to 1e-9) or a coordinate is not finite
Eigen::MatrixX2d projected_points(const TriMesh& mesh, const Eigen::Matrix3d& view);

/// Outline of the mesh's projection: the border of the union of the projected triangles, holes
/// included, as pieces of projected edges in no particular direction.
///
/// An edge can bound the union only where no triangle of its own lies on one of its sides: contour
/// edges between a front and a back face, and border edges. Such an edge is on the outline where at
/// least one of the two points beside it, 1e-9 of the size away, is in no triangle. So contours
/// inside (folds that hide something) are left out, and a border of several layers is there once a
/// layer. Ends are accurate to about 1e-9 of the size, and pieces shorter than 1e-6 of it are left
/// out: at places where a contour goes behind a layer round-off would make some up.
///
/// Works on any list of triangles: open, crossing itself, edge-on or welded or not (cracks below
/// 1e-9 of the size are no outline). Triangles that are edge-on cover nothing.
///
/// Time grows with the contour edges times the layers of triangles behind them.
///
/// @param points     n x 2, of `projected_points` (m)
/// @param triangles  m x 3
/// @throws Error     when no triangle has an area in the view, or all edges are shorter than 1e-6
///                   of the size
std::vector<PlanarSegment> projected_outline(const Eigen::MatrixX2d& points,
                                             const Eigen::MatrixX3i& triangles);

}  // namespace geoprior
