#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace geoprior {

/// A motion sampled at ascending parameters: of each, one row a point (or any tuple of numbers).
struct SampledMotion {
  std::vector<double> parameters;
  std::vector<Eigen::MatrixXd> x;  ///< all of one size
};

/// Length of the way over the parameter that it took: the mean over the rows; 0 for fewer than two
/// samples.
/// @throws Error  for parameters that do not ascend, or samples of different sizes
double mean_speed(const SampledMotion& motion);

/// Jump |v+ - v-| of the velocity of the row that jumps most at a parameter b, from the samples at
/// b - 2h, b - h, b, b + h, b + 2h.
///
/// A difference (x(b + h) - x(b)) / h is off by h x''/2, which is as large as a small jump. Each of
/// the one-sided velocities is therefore extrapolated from the steps h and 2h,
///     v+ = (4 x(b + h) - 3 x(b) - x(b + 2h)) / 2h,
/// after which curvature does not count, not even one that is another on each side: two parabolas
/// that join with one tangent have no jump. What is left of a C1 motion is h^2/3 times the jump of
/// its third derivative, and the round-off of x over h. With h = 2^-13 of the unit in which a
/// motion changes its velocity, that is 1e-8 and, for places a hundred times the way in that unit,
/// 1e-9 of the speed. A kink is seen whole, wherever it is not within 2h of another.
///
/// @param step  h, positive; a power of two, and parameters that are multiples of it, leave the
///              samples exactly where the formula has them
/// @return      absent unless all five samples are there, to 1e-6 of the step
/// @throws Error  as `mean_speed`, or for a step that is not positive
std::optional<double> velocity_jump(const SampledMotion& motion, double at, double step);

/// The largest jump at any of these parameters over the mean speed: absent where none has all its
/// samples, 0 for what rests.
std::optional<double> relative_velocity_jump(const SampledMotion& motion,
                                             std::span<const double> at, double step);

}  // namespace geoprior
