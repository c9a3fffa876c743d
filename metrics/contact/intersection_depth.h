#pragma once

#include <array>
#include <vector>

#include "core/mesh.h"

namespace geoprior {

/// How far triangles have gone through each other (m): the largest, over the intersecting pairs, of
/// the shortest way along the normal of one of the two that takes them apart; 0 without a pair.
///
/// A pair cannot be deeper than its triangles are high, so a layer that has gone through far shows
/// as no more than the size of the triangles along its seam: compare meshes of like size, and read
/// it beside the number of pairs. Triangles that fold onto each other in one plane have depth 0.
///
/// @param pairs  of triangles that intersect (metrics/contact/self_contact.h)
double intersection_depth(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                          const std::vector<std::array<int, 2>>& pairs);

/// Finds the pairs itself.
/// @throws Error  on a coordinate that is not finite (names the vertex)
double intersection_depth(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F);

}  // namespace geoprior
