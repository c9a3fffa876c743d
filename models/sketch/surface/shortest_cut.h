#pragma once

#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"

namespace geoprior::sketch {

/// Edges to cut so that a piece of surface becomes a disc; none for a disc.
///
/// Borders are joined one by one, each time by the shortest path of edges from those joined so far
/// to the nearest other one (of two borders: the shortest cut there is). A handle is then opened
/// along the shortest loops of a tree of shortest paths and a spanning tree of the triangles beside
/// it (tree and cotree; Erickson and Har-Peled 2004, Erickson and Whittlesey 2005). A closed piece
/// of genus 0 is slit between two vertices that lie far apart: the farthest from the farthest from
/// vertex 0. Equal lengths are decided by index.
///
/// @param piece   connected, oriented, manifold; no vertex where it only touches itself
/// @return        pairs of vertices, lower one first, each edge once
/// @throws Error  when it is not connected
std::vector<Edge> shortest_cut(const TriMesh& piece);

}  // namespace geoprior::sketch
