#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace geoprior {

/// A closed polygon: the last point is joined to the first.
using PlanarLoop = std::vector<Eigen::Vector2d>;

/// How often a closed polygon winds about a point, counter-clockwise positive. Exact; a point on
/// the polygon counts as one just right of it, or just above where it is horizontal.
int winding_number(const PlanarLoop& loop, const Eigen::Vector2d& p);

/// Pairs of segments of closed polygons that meet elsewhere than in the end that two neighbours
/// share: 0 for outlines that are simple and keep apart. Exact.
///
/// Touching counts: an outline that runs back along itself (both sides of a closed dart) has such
/// pairs though nothing overlaps; `overlapping_triangles` tells them apart. Points that repeat the
/// one before are left out.
int outline_crossings(std::span<const PlanarLoop> loops);

/// Two triangles whose interiors have points in common.
struct TrianglePair {
  int first = 0, second = 0;  ///< ascending
  double area = 0;            ///< in common (m^2), rounded
};

/// All such pairs of a planar triangulation, whatever way round the triangles are; ascending. None
/// exactly when the triangles lie side by side, that is, no point is covered twice. Which pairs
/// there are is decided exactly; triangles without area overlap nothing, and touching is no
/// overlap. A triangle that was turned over lies on its neighbours, and so is in pairs with them.
///
/// The sum of the areas counts a point that k triangles cover k (k - 1) / 2 times.
///
/// @param points     n x 2 (m), finite
/// @param triangles  m x 3
/// @param group      per triangle: only pairs of different groups count; empty: all do
/// @throws Error     on a coordinate that is not finite, or a group's size that is not m
std::vector<TrianglePair> overlapping_triangles(const Eigen::MatrixX2d& points,
                                                const Eigen::MatrixX3i& triangles,
                                                std::span<const int> group = {});

}  // namespace geoprior
