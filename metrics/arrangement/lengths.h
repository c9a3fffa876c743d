#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace geoprior {

/// By how much a value is out of the range from `low` to `high`; 0 inside.
double out_of_range(double value, double low, double high);

/// Distance of a point from that of the segment from `a` to `b` at `along`, 0 at `a` and 1 at `b`
/// (m): the gap at which something hangs that is to be attached there.
double attachment_gap(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      double along);

/// Distance from the segment from `a` to `b` (m).
double distance_from_segment(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                             const Eigen::Vector3d& b);

/// Two neighbours in a row of points, by their indices, and their distance (m).
struct NeighbourPitch {
  int before = 0, after = 0;
  double distance = 0;
};

/// Neighbours in a row of points, along it: one pair fewer than there are points.
///
/// @param places  as many: where each is in the row; equal ones keep their order
/// @throws Error  when sizes differ
std::vector<NeighbourPitch> neighbour_pitches(std::span<const Eigen::Vector3d> points,
                                              std::span<const double> places);

}  // namespace geoprior
