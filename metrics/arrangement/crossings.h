#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace geoprior {

/// All points within `radius` of the segment from `a` to `b` (m): a capsule.
struct ThickSegment {
  Eigen::Vector3d a, b;
  double radius = 0;
};

/// Distance of two segments (m); each may be a point.
/// Source: Ericson, Real-Time Collision Detection (2005), section 5.1.9.
double axes_distance(const ThickSegment& first, const ThickSegment& second);

/// Pairs (lower, higher), ascending, whose capsules are deeper in each other than `tolerance` (m):
/// the distance of the segments is under the sum of the radii by more than that.
///
/// Candidates come from a grid in plan: capsules of similar length that do not stand in each
/// other's shade by the hundred take a time in proportion to their number.
/// @param may_cross  whether a pair is not looked at; empty: all are
std::vector<std::pair<int, int>> crossings(
    std::span<const ThickSegment> segments, double tolerance,
    const std::function<bool(int lower, int higher)>& may_cross = {});

}  // namespace geoprior
