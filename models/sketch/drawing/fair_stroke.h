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

/// Smoothing spline through the points of a stroke, with corners where they are found.
///
///   minimise  sum |x_i - y_i|^2 + lambda sum_{i not a corner} |x_{i-1} - 2 x_i + x_{i+1}|^2
///
/// y are points at equal distances along the stroke. At a corner the second difference costs
/// nothing, so that it is a kink between two fair curves.
///
/// - lambda: least error of a point that is predicted without its neighbours nearer than the
///   tremor's correlation (cross-validation that leaves out blocks: tremor is smooth itself, and
///   leaving out single points would take it for shape). That is best for the mean square; a tenth
///   of it bounds the largest error better, which is what counts here, and is taken.
/// - Corners: one at a time where freeing the second difference lowers the minimum most,
///   lambda (d x)^2 / (1 - lambda d A^-1 d'); accepted when that is more than noise gives anywhere,
///   whose level is the median over the stroke. Then each is moved to where the minimum is lowest.
///
/// It is for tremor, which is fast against the shape. What is drawn slowly askew is shape, and
/// corners whose sides are shorter than some lengths of the tremor, or that turn little, are
/// rounded. Of tremor in a narrow band of wavelengths about 3 % of the diagonal, with a standard
/// deviation of 1 %, the largest error left is .7 of that in the median of twelve silhouettes and
/// ten seeds, and less than .6 in a third of them; a raw stroke's is three times it.
///
/// @param points  closed: the last is joined to the first
/// @return        nothing for a stroke that is not noisy, which is one of few points, or of few
///                changes between left and right turns
/// Source: Reinsch 1967 (the functional); Burman, Chow and Nolan 1994 (blocks left out).
std::optional<FairedStroke> fair_stroke(const std::vector<Eigen::Vector2d>& points, bool closed);

/// Whether a stroke turns to and fro as only a trembling hand does: often, and by no small angles.
bool is_trembling(const std::vector<Eigen::Vector2d>& points, bool closed);

}  // namespace geoprior::sketch
