#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "metrics/contact/joint_region.h"

namespace geoprior {

/// Number of pairs of triangles that intersect each other; exact predicates, so no tolerance.
///
/// Two triangles with a common edge count when they fold onto each other in one plane; with one
/// common vertex when the opposite edge of one meets the other; otherwise when they meet at all
/// (touching counts). Degenerate triangles are left out. The number depends on the tessellation:
/// `overlap_volume` does not, and is the primary measure of self-contact.
///
/// @param V,F  any triangles; they need be neither closed nor manifold
/// @throws Error  on a coordinate that is not finite (names the vertex)
/// Source: the rules of CGAL 5.5, Polygon Mesh Processing, self_intersections, here for indexed
/// triangles that need not be manifold.
int intersecting_pairs(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F);

/// The pairs themselves, each with the lower triangle first, in ascending order.
std::vector<std::array<int, 2>> intersecting_triangles(const Eigen::MatrixX3d& V,
                                                       const Eigen::MatrixX3i& F);

/// The pairs whose triangles belong to different layers, in the same order.
/// @param layer  of each triangle
std::vector<std::array<int, 2>> pairs_between_layers(std::span<const std::array<int, 2>> pairs,
                                                     std::span<const int> layer);

/// Number of the pairs of which at least one triangle belongs to the region.
int pairs_in_region(std::span<const std::array<int, 2>> pairs, const JointRegion& region);

}  // namespace geoprior
