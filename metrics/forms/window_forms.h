#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// First fundamental form of a surface at one of its points: E dx^2 + 2 F dx dy + G dy^2.
struct FundamentalForm {
  double E = 0, F = 0, G = 0;

  /// Frobenius norm of its matrix.
  [[nodiscard]] double norm() const;
};
FundamentalForm operator-(const FundamentalForm& a, const FundamentalForm& b);

/// Order of the central differences that a form is measured by: error of the derivatives h^2, h^4.
enum class DifferenceOrder { second = 2, fourth = 4 };

/// First fundamental forms inside small square windows of points, from the points alone.
///
/// With s points a period of a sine, a derivative of fourth order falls short by (2 pi / s)^4 / 30,
/// that is 2e-5 at s = 40; one of second order by (2 pi / s)^2 / 6: 0.4, 2.6 and 10 percent at
/// s = 40, 16 and 8.
///
/// @param points  windows of `side` x `side` points, one after the other, rows along y
/// @param step    between neighbours along x and y, in the parameter
/// @return        of each window the (side - order)^2 points that differences reach around
/// @throws Error  when the points are no whole number of windows, or a window has no inner point
std::vector<FundamentalForm> window_forms(const Eigen::MatrixX3d& points, int side, double step,
                                          DifferenceOrder order);

/// Length of a closed curve through points that are evenly spaced in its parameter: twice the
/// polygon through all of them against the one through every other, (4 L_h - L_2h) / 3, whose error
/// is of fourth order.
/// @param points  an even number of them; the last is joined with the first
/// @throws Error  for fewer than four points, or an odd number
double closed_curve_length(const Eigen::MatrixX3d& points);

}  // namespace geoprior
