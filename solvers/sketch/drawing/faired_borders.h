#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// A trembling line and how much it trembles.
struct FairedLine {
  std::vector<Eigen::Vector2d> points;
  double noise = 0;  ///< standard deviation of a coordinate, as estimated (m)
};

/// Takes the noise from points that were drawn one after another at about even distances.
///
/// Of independent noise of deviation s the third differences have the deviation sqrt(20) s, those
/// of a smooth curve are of the third order in the spacing: s is their median over 0.6745 sqrt(20).
/// The faired points minimise sum |x - y|^2 + lambda sum |third difference of x|^2, with lambda
/// such that they move by 0.92 s (of which a smoother that keeps about a tenth of the noise leaves
/// the rest). Lines of fewer than twelve points, of uneven distances (one in twenty above
/// 3.5 times the median), or with s below
/// `least` are left as they are.
///
/// It cannot tell a tremor that neighbouring points share, and rounds corners: a line is to have
/// none.
/// @param hold  whether the first and the last point stay
FairedLine fair_line(const std::vector<Eigen::Vector2d>& points, bool closed,
                     std::array<bool, 2> hold, double least);

/// The view with its borders faired, point for point. Ends that meet other borders stay, and so do
/// corners (a turn of more than 60 degrees between the directions of five points on either side).
/// @param snap  share of the diagonal of the borders within which ends meet
View faired_borders(const View& view, double snap);

}  // namespace geoprior::sketch
