#pragma once

#include "core/mesh.h"

namespace geoprior {

/// Where a drawing on a surface would be, if the surface's deformation were all that moved it.
///
/// Every vertex keeps its nearest point of the surface and its offset from there in the surface's
/// own frame (normal interpolated from the vertices, tangent along the triangle's first edge):
/// exact for a surface that moves rigidly. Offsets keep their lengths, so where the surface
/// stretches by the factor s, the foot of a detail of radius r, which lies on it, comes (s - 1) r
/// wide of a detail that keeps its size.
///
/// @param drawn        on `before`; vertices far from it follow their nearest point all the same
/// @param before, now  vertices of the surface in two frames, with the same triangles
/// @throws Error       unless both surfaces have the same triangles, at least one with an area
TriMesh carried_drawing(const TriMesh& drawn, const TriMesh& before, const TriMesh& now);

/// What a viewer sees jump between two frames (m): the largest displacement of the drawn surface
/// beside the deformation of the base.
struct DrawnPop {
  double came = 0;  ///< largest distance of a point drawn now from what was drawn, carried along
  double went = 0;  ///< largest distance of a point that was drawn, carried along, from what is now

  [[nodiscard]] double largest() const { return came > went ? came : went; }
};

/// The two sides of the Hausdorff distance between the drawing carried along and the drawing of
/// now, so that geometry counts by its size and not by its number: a spike that appears at its full
/// height counts that height, one that grows over n frames a n-th of it a frame, a hole that is
/// cut at once its radius. Holes, meshes and spikes are the same to it; identities, weights and
/// triangulations do not matter.
///
/// What it cannot see: a slide of the drawing along itself, and of a slide across only the part
/// along the normals of the drawing. A detail that jumps from one place to another comes and
/// goes, and is seen.
///
/// Per degree or unit of motion: divide by the step of the parameter between the frames.
///
/// @param base_before, base_now      the bare surface, with the same triangles
/// @param drawn_before, drawn_now    everything that is drawn: with the base where it is seen
///                                   between spikes or meshes, without it where a surface with
///                                   holes stands for it
/// @param spacing  of the samples (m), positive; vertices are always among them
/// @throws Error   as `carried_drawing`, and for a drawing without triangles
DrawnPop drawn_pop(const TriMesh& base_before, const TriMesh& drawn_before, const TriMesh& base_now,
                   const TriMesh& drawn_now, double spacing);

}  // namespace geoprior
