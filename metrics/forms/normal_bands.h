#pragma once

#include <Eigen/Core>
#include <span>

namespace geoprior {

/// Unit normals along a closed curve of a surface: along it by differences of second order, across
/// it from one neighbouring curve to the other.
///
/// @param curve         evenly spaced in its parameter; the last point is joined with the first
/// @param left, right   the curve moved a little to both sides, as many points each
/// @throws Error        for fewer than three points, other counts, or a point without a normal
Eigen::MatrixX3d curve_normals(const Eigen::MatrixX3d& curve, const Eigen::MatrixX3d& left,
                               const Eigen::MatrixX3d& right);

/// Power of a periodic signal in bands of frequency: sum of |c_k|^2 over k in (edge, next edge],
/// c_k the Fourier coefficients of each column, both signs of k, k counted in periods of the curve.
/// With the mean, all bands up to half the samples sum to the mean square (Parseval).
///
/// @param edges  increasing, at least 0, two or more
/// @return       one fewer than edges
/// @throws Error for no samples, or edges that do not increase
Eigen::VectorXd band_power(const Eigen::MatrixX3d& samples, std::span<const double> edges);

/// Slope of log y over log x by least squares.
/// @throws Error  for fewer than two points, other counts, or a number that is not positive
double log_slope(std::span<const double> x, std::span<const double> y);

}  // namespace geoprior
