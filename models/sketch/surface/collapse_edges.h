#pragma once

#include "core/mesh.h"

namespace geoprior::sketch {

/// Merges the ends of edges that are shorter than a length into the one of the lower number, where
/// the mesh stays a manifold: the two have exactly their edge's opposite corners as common
/// neighbours. Ends keep the place of the vertex that stays.
///
/// @param mesh  closed, manifold; its triangles change, vertices that none uses are taken out
/// @return      number of edges that were collapsed
/// Source of the condition: Dey, Edelsbrunner, Guha and Nekhayev 1999 (link condition).
int collapse_short_edges(TriMesh& mesh, double length);

}  // namespace geoprior::sketch
