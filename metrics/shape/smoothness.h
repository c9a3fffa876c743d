#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace geoprior {

/// Whether neighbouring parameters are equally far apart, within 1e-9 of the step; true for fewer
/// than three.
bool equally_spaced(std::span<const double> parameters);

/// Largest second difference |x_{i+1} - 2 x_i + x_{i-1}| of a vertex position over a sweep of equal
/// steps (m).
///
/// A pop of size J shows as about J whatever the step, while smooth motion falls as step^2. Rigid
/// motion counts too (radius * step^2 for a rotation): give positions in the frame of the bone to
/// leave it out. Compare it at equal steps only; `motion_smoothness` does not depend on them.
///
/// @param positions   one n x 3 matrix a frame, in order of parameter
/// @param parameters  of the frames
/// @param vertices    rows to look at; empty: all
/// @return            0 for fewer than three frames
/// @throws Error      when the parameters are not equally spaced or the sizes differ
double second_difference_max(const std::vector<Eigen::MatrixX3d>& positions,
                             std::span<const double> parameters,
                             const std::vector<int>& vertices = {});

/// How smoothly vertices move along a sweep, per unit of its parameter p, whatever its steps.
struct MotionSmoothness {
  /// Largest change of velocity per unit (m per unit^2): second divided difference over three
  /// frames. Converges to max |x''(p)| of a smooth motion; where the velocity jumps by c it is
  /// about c / step and where the place jumps by J about J / step^2, so it grows without bound as
  /// the sweep is refined.
  double velocity_change = 0;
  /// Largest jump of place (m): how far apart the middle of a step is extrapolated from the two
  /// frames before and from the two after it. A lone jump of J gives J at any step; smooth motion
  /// step^3 |x'''| / 2, a jump c of velocity c step / 2: both vanish as the sweep is refined.
  double jump = 0;
};

/// @param positions   one n x 3 matrix a frame, in order of parameter
/// @param parameters  of the frames, rising or falling throughout
/// @param vertices    rows to look at; empty: all
/// @return            absent for fewer than four frames
/// @throws Error      on parameters that do not rise or fall throughout, or sizes that differ
std::optional<MotionSmoothness> motion_smoothness(const std::vector<Eigen::MatrixX3d>& positions,
                                                  std::span<const double> parameters,
                                                  const std::vector<int>& vertices = {});

}  // namespace geoprior
