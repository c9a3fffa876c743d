#pragma once

#include <Eigen/Core>

namespace geoprior {

/// How two edges of a pattern that are sewn together differ in length.
struct SeamMismatch {
  double left_length = 0, right_length = 0;  ///< m
  double relative = 0;                       ///< |left - right| over the mean of the two lengths
  double shift_max = 0;  ///< largest |shift| of a point from its partner along the seam (m)
  double segment_max =
      0;  ///< largest |left - right| of two segments sewn together, over their mean
};

/// Arc length along the left edge less that along the right one, at each pair of points (m): how
/// far a point has slid from its partner when both edges are laid along each other from their
/// starts. The first is 0, the last the difference of the lengths.
///
/// @param left,right  n x 2, n >= 2 (m): polylines whose i-th points are sewn together, so both run
///                    the same way along the seam (the right one's border runs the other way)
/// @throws Error      unless both have the same number of points, two or more, all finite
Eigen::VectorXd seam_shift(const Eigen::MatrixX2d& left, const Eigen::MatrixX2d& right);

/// Summary of the same.
///
/// Sees lengths alone: two edges of equal length that curve differently sew up into a surface with
/// another shape, and neither edge needs to have the length that the seam has in space. `shift_max`
/// depends on where the seam starts, and `segment_max` on how finely it is cut: it is noisy where
/// segments are short. Segments of length 0 on both sides match.
/// @throws Error  as `seam_shift`; when both edges have no length
SeamMismatch seam_mismatch(const Eigen::MatrixX2d& left, const Eigen::MatrixX2d& right);

}  // namespace geoprior
