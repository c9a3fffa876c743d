#pragma once

#include "core/mesh.h"

namespace geoprior {

/// Hausdorff distance of two triangle surfaces (m): the largest distance of a point of one from the
/// other, both ways.
///
/// Taken at samples: the vertices, and the centres of the pieces when the triangles are cut into
/// ones with edges of at most `spacing`. The distance of a sample is exact; the supremum is missed
/// by at most 2/3 of the spacing, and by far less where the surfaces are nearly parallel. Borders
/// count: a smaller piece of the same surface is not at distance 0.
///
/// @param a,b      triangles without connectivity requirements; degenerate ones are left out
/// @param spacing  of the samples (m), positive
/// @throws Error   on a surface without triangles, a coordinate that is not finite, or a spacing
///                 that is not positive
double hausdorff_distance(const TriMesh& a, const TriMesh& b, double spacing);

/// One side of it: the largest distance of a point of `from` from `to` (m).
/// @throws Error   as `hausdorff_distance`
double largest_distance(const TriMesh& from, const TriMesh& to, double spacing);

/// Largest distance of points from a surface (m); 0 for no points.
/// @throws Error  on a surface without triangles
double largest_distance(const Eigen::MatrixX3d& points, const TriMesh& to);

/// How far points of one surface are from another, over its area.
struct SurfaceDeviation {
  double rms = 0, mean = 0, max = 0;  ///< m
};

/// Distances of surface `a` from surface `b`, weighted by the area of `a`: taken at the centres of
/// the pieces when the triangles are cut into ones with edges of at most `spacing`. Triangles that
/// `b` has too, corner for corner, are at distance 0. Not symmetric.
/// @throws Error   as `hausdorff_distance`
SurfaceDeviation surface_deviation(const TriMesh& a, const TriMesh& b, double spacing);

/// The larger of the deviations of `a` from `b` and of `b` from `a`, value by value: symmetric.
/// @throws Error  as `hausdorff_distance`
SurfaceDeviation mutual_deviation(const TriMesh& a, const TriMesh& b, double spacing);

}  // namespace geoprior
