#pragma once

#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// Largest angle (radians, 0 to pi) between the normals of two triangles on both sides of a seam:
/// they share an edge, and one of them has a marked vertex while the other has none. 0 without a
/// seam. Triangles without area and edges of more than two triangles are left out.
///
/// @param marked  per vertex, not 0 where something was pasted
/// @throws Error  when `marked` is not as long as the mesh has vertices
double largest_seam_angle(const TriMesh& mesh, const std::vector<char>& marked);

/// What differs between the two sides of a seam, at one place of it.
struct SeamJump {
  double position = 0;   ///< m
  double angle = 0;      ///< between the normals (rad)
  double curvature = 0;  ///< of the mean curvature (1/m)
};

struct SeamJumps {
  int places = 0;
  SeamJump rms, largest;  ///< each quantity by itself; 0 without a place
};

/// How well two surfaces are joined: at the middle of every edge from a marked to an unmarked
/// vertex each side is continued by a quadric and the two are compared, so that bridging triangles
/// hide no step and the mesh itself does not count as a fold.
///
/// A quadric is the least-squares fit to heights over the common plane, of the end of the edge and
/// the vertices of the same side up to two edges away. A smooth surface has jumps that vanish with
/// the edges' length h: position as h^3, angle as h^2, curvature as h. Places where a side has too
/// few vertices for a quadric are left out, and so are those where a side is steeper than 60
/// degrees over the plane: heights do not describe it.
///
/// @param marked  per vertex, not 0 where something was pasted
/// @throws Error  when `marked` is not as long as the mesh has vertices
SeamJumps seam_jumps(const TriMesh& mesh, const std::vector<char>& marked);

}  // namespace geoprior
