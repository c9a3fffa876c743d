#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "core/connectivity.h"

namespace geoprior {

using CapTriangle = std::array<int, 3>;

/// The border of a mesh, as closed loops that come to no vertex twice.
struct BoundaryLoops {
  std::vector<std::vector<int>> loops;  ///< vertices, in the direction of the boundary edges
  int stray_edges = 0;  ///< boundary edges that lead into no loop: about edges of three triangles
};

/// Walks along the boundary edges; a walk that comes to one of its vertices again has found a loop
/// there. So holes that touch at a vertex are loops of their own, or one loop after the other.
/// Source of the order: `boundary_edges`, so the result depends on the triangles alone.
BoundaryLoops boundary_loops(const Eigen::MatrixX3i& F);

/// Triangles over the vertices of a boundary loop, and no others, that close it.
///
/// Of all triangulations of a loop of up to `kExactLoop` vertices the one of least cost, by dynamic
/// programming over its chords in O(n^3) (Barequet and Sharir 1995, whose cost is the area). Here
/// the cost of a triangle is its area, plus a hundredth of the square of its new chord, which tells
/// apart the triangulations of a plane loop that have one area, plus the square of its longest side
/// where it has no area or faces against the loop's area vector. Of longer loops every second
/// vertex is cut off first, until no more are left.
///
/// The cap turns the way that the skin does; it may cut through other parts of the mesh, which it
/// does not see.
///
/// @param V        positions (m)
/// @param loop     three or more vertices, in the direction of the boundary edges
/// @param is_edge  whether the mesh has an edge between two vertices: a chord there would be the
///                 edge of more than two triangles
/// @return  n - 2 triangles; none where every triangulation needs such a chord, or where the least
///          one has no area (a slit)
std::vector<CapTriangle> cap_of_loop(const Eigen::MatrixX3d& V, const std::vector<int>& loop,
                                     const std::function<bool(int, int)>& is_edge);

/// Longest loop of which all triangulations are compared.
constexpr int kExactLoop = 300;

}  // namespace geoprior
