#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace geoprior::sketch {

/// A stroke without the tremor of the hand that drew it.
struct FairedStroke {
  std::vector<Eigen::Vector2d> points;
  double noise = 0;  ///< standard deviation that was taken off, a coordinate (m)
  double moved = 0;  ///< largest distance of a drawn point from `points` (m)
  std::vector<Eigen::Vector2d> corners;  ///< that were found and kept
};

/// Changes between left and right turns that tell a trembling hand from teeth that were meant, and
/// those that do for short strokes beside others of that hand.
inline constexpr int kTremblingChanges = 30, kChangesBesideTremor = 12;

/// Takes tremor off a stroke below the band of its waves, and keeps its corners.
///
///   minimise  sum |x_i - y_i|^2 + lambda sum |D^4 x_i|^2,  gain 1 / (1 + (k / k_c)^8) of k waves
///
/// y are points of the stroke at equal times (`in_equal_times`), D^4 fourth differences, and
/// lambda = (2 sin(pi k_c / n))^-8 for n points.
///
/// - k_c: 0.3 of the tremor's mean number of waves; of a wide band less, down to 0.2, until 3 % of
///   the tremor are left.
/// - Corners: what the smoothing takes off a kink at c is known, lambda A^-1 D^6 e_c times the
///   kink's second difference (A the matrix of the minimum). Below the cut that second difference
///   is a pulse A^-1 e_c: the largest one is a corner when it is more than tremor leaves anywhere,
///   half of what is there has the pulse's shape, and it turns by 0.4 rad; sizes of all corners are
///   fitted together, and what was taken off is put back. No part of the curve becomes freer by a
///   corner: a wrong one does no more harm than a missed one.
///
/// It is for tremor, which is fast against the shape. What is drawn slowly askew is shape; corners
/// nearer to each other than half a wave of the cut (1.7 of the tremor) are taken for one. A hand
/// that ends a line beside its start leaves a step there, which may become a small corner.
///
/// Largest error left, of a tremor of 1 % of the diagonal (standard deviation), over it; fifteen
/// silhouettes, ten seeds:
///
///   waves (mean length, spread of their number) | median, worst | within 0.6 | raw, median
///   3 % of the diagonal, 0.2                    |   0.30, 0.87  |    93 %    |     3.0
///   2 %, 0.2                                    |   0.22, 0.95  |    97 %    |     3.1
///   5 %, 0.2                                    |   0.59, 1.22  |    55 %    |     3.0
///   3 %, 0.4                                    |   0.66, 1.36  |    44 %    |     3.1
///
/// Of points whose time is lost (brought to equal distances, or thinned) it is 0.8, worst 1.6; of a
/// smaller tremor it is more (0.3 %: 0.7, worst 1.9), since corners are as hard to place.
///
/// @param points  closed: the last is joined to the first
/// @param changes as of `is_trembling`
/// @return        nothing for a stroke that does not tremble
/// Source: Reinsch 1967 (the functional).
std::optional<FairedStroke> fair_stroke(const std::vector<Eigen::Vector2d>& points, bool closed,
                                        int changes = kTremblingChanges);

/// Whether a stroke turns to and fro as only a trembling hand does: often, and by no small angles.
/// A tremor that goes round in loops, always the same way, is not seen.
/// @param changes  between left and right turns that are needed, half as many as points
bool is_trembling(const std::vector<Eigen::Vector2d>& points, bool closed,
                  int changes = kTremblingChanges);

}  // namespace geoprior::sketch
