#pragma once

#include <vector>

#include "core/angles.h"
#include "core/mesh.h"

namespace geoprior {

/// Angle between the normals of two triangles above which their edge counts as sharp (rad): 20
/// degrees, the turn of a cylinder of eighteen sides.
inline constexpr double kSharpTurn = 20 * kDegree;

/// Share of a surface's turning that lies in sharp edges,
///   sum over sharp edges of l_e |theta_e| / sum over all interior edges of l_e |theta_e|,
/// l_e the length of an edge, theta_e the angle between its triangles' normals: 0 for a smooth
/// surface, 1 for a polyhedron with plane faces and sharp edges. A flat surface has 0.
///
/// The denominator is twice the total mean curvature (Cohen-Steiner and Morvan 2003, of absolute
/// values), which a finer mesh of the same shape keeps; so the share tells a crease, which stays as
/// sharp in any mesh, from a bend, whose edges get flatter. It depends on the mesh where edges are
/// long against the radius r of a bend: a cylinder is sharp whose sides are wider than r `sharp`.
/// It is blind to which creases are wanted, to whether the surface is developable, and to noise
/// whose edges turn by less than `sharp`. Edges with one triangle or more than two, and with a
/// triangle without area, do not count.
///
/// @param sharp     threshold of |theta| (rad), exclusive
/// @param left_out  a value a vertex, or empty: edges between two such vertices do not count (those
///                  that a drawing asks for)
/// @throws Error    on a threshold that is not positive, or a mask of another length
/// Source: ours; turning as in Cohen-Steiner and Morvan, Restricted Delaunay Triangulations and
/// Normal Cycle, 2003.
double sharp_turning_share(const TriMesh& mesh, double sharp = kSharpTurn,
                           const std::vector<bool>& left_out = {});

}  // namespace geoprior
