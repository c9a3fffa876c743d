#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::sketch {

/// Where the tremor of a stroke is among its waves.
struct TremorBand {
  double waves = 0;   ///< mean number of waves along the stroke
  double spread = 0;  ///< standard deviation of that number
  double sigma = 0;   ///< standard deviation of the tremor, a coordinate (m)
  /// Power between the shape and the tremor, from a quarter to a half of its waves, over the
  /// tremor's.
  double between = 0;
};

/// A stroke at equal steps of time.
struct TimedStroke {
  Eigen::MatrixX2d samples;  ///< row each; of an open stroke the ends are the first and the last
  TremorBand band;
};

/// Brings a trembling stroke to equal steps of the time in which the hand drew it. Along time the
/// tremor is a narrow band of waves, and the shape is slow: a low-pass parts them. Along the length
/// of the drawn line they are mixed, because a trembling pen is fast halfway between its turns.
///
/// The time is not written in a drawing. Of three guesses that one is taken which leaves least
/// between the shape and the tremor:
///
/// - one step from point to point: pens are sampled at equal times;
/// - the length of the line;
/// - length times the cube root of curvature: what was bent was drawn slowly. Of an ellipse that is
///   its time exactly. For lines whose points a program has thinned or moved.
///
/// Band: round the peak of k^3 P(k), P the power of k waves along the stroke; mean and standard
/// deviation of P from a half to twice as many waves. Edges of drawings have powers of k^-4 or
/// less, so that they make no peak.
///
/// @param points  three or more; closed: the last is joined to the first
/// Source: Lacquaniti, Terzuolo and Viviani 1983 (speed and curvature of drawing hands).
TimedStroke in_equal_times(const std::vector<Eigen::Vector2d>& points, bool closed);

}  // namespace geoprior::sketch
