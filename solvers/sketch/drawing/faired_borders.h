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
  int freedom = 0;   ///< coordinates that the estimate rests on; 0: the line is left as it is
};

/// Takes the noise from points that were drawn one after another at about even distances.
///
/// Of independent noise of deviation s the third differences have the deviation sqrt(20) s, those
/// of a smooth curve are of the third order in the spacing: their median over 0.6745 sqrt(20) tells
/// whether a line trembles. The faired points minimise
///   sum |x - y|^2 + lambda sum |third difference of x|^2,
/// with the lambda that makes the drawn points most likely. Lines of fewer than twelve points (six
/// where the noise is known), of uneven distances (one in twenty above 3.5 times the median), or
/// that tremble by less than `least` are left as they are.
///
/// It cannot tell a tremor that neighbouring points share, and rounds corners: a line is to have
/// none.
/// @param hold   whether the first and the last point stay
/// @param noise  standard deviation when it is known (m); 0: it is found with lambda
/// Source: Wahba, A comparison of GCV and GML for choosing the smoothing parameter, 1985.
FairedLine fair_line(const std::vector<Eigen::Vector2d>& points, bool closed,
                     std::array<bool, 2> hold, double least, double noise = 0);

/// A view without the tremor of its borders.
struct FairedView {
  View view;            ///< point for point
  double noise = 0;     ///< standard deviation of a drawn coordinate, of all borders together (m)
  double diagonal = 0;  ///< of the box about the drawn borders (m)
};

/// The view with its borders faired, point for point: each line's noise is found, then all lines
/// are faired for the noise that they have together. Ends that meet other borders stay, and so do
/// corners: a turn of more than 60 degrees, and 1.5 deviations of what noise makes of it, between
/// the shortest chords of five points and of eight deviations of the noise.
/// @param snap  share of the diagonal of the borders within which ends meet
FairedView faired_borders(const View& view, double snap);

}  // namespace geoprior::sketch
