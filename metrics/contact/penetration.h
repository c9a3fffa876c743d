#pragma once

#include "core/mesh.h"

namespace geoprior {

/// How far two closed surfaces are in each other (m): the largest distance from one surface of a
/// point of the other that is inside of it, both ways; 0 for surfaces that are apart or touch.
///
/// Points are taken at the vertices, the middles of the edges and the centres of the triangles; the
/// distance of each is exact. What enters by less than a triangle's size, between these points, is
/// not seen. Two surfaces of which one is wholly inside the other have the depth of its innermost
/// point, which is less than the way out for the whole of it.
///
/// Cost: a query of a tree for each point within the common box that may be the deepest.
/// @param a,b      closed and outward oriented; one without triangles is apart from all
/// @throws Error   on a coordinate that is not finite, or when no triangle has an area
/// Source of the sign: Baerentzen and Aanaes 2005, "Signed distance computation using the angle
/// weighted pseudonormal".
double penetration(const TriMesh& a, const TriMesh& b);

}  // namespace geoprior
