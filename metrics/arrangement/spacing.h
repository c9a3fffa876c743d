#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace geoprior {

/// How close elements are that are to keep apart: the distance of two of them is to be at least
/// the sum of their extents (m).
struct SpacingCheck {
  std::optional<double> smallest_ratio;  ///< of a pair: distance over the sum of the extents
  /// Pairs (lower, higher) of points whose distance falls short by over the tolerance.
  std::vector<std::pair<int, int>> too_close;
};

/// Exact, all pairs considered: a grid leaves out those that cannot count.
///
/// An element of extent 0 is not seen, so that it is left out.
/// @param extents    as many as points, not negative
/// @param tolerance  m
/// @throws Error     when sizes differ, on an extent that is negative or not finite (names it)
SpacingCheck check_spacing(std::span<const Eigen::Vector3d> points, std::span<const double> extents,
                           double tolerance);

/// Distance of each point from the nearest other one (m): as many as points, none for fewer than
/// two.
std::vector<double> nearest_neighbour_distances(std::span<const Eigen::Vector3d> points);

/// Standard deviation over mean, of the whole population; absent without values, or where they
/// have the mean 0.
std::optional<double> coefficient_of_variation(std::span<const double> values);

/// Largest distance of a place from the nearest of the points (m): absent where there are no
/// places or no points.
std::optional<double> largest_hole(std::span<const Eigen::Vector3d> places,
                                   std::span<const Eigen::Vector3d> points);

}  // namespace geoprior
