#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>
#include <vector>

namespace geoprior::sketch {

/// Ellipse in a plane: centre + major cos s direction + minor sin s (direction turned by +90 deg).
struct Ellipse {
  Eigen::Vector2d centre{0, 0};
  double major = 0, minor = 0;      ///< half axes, major >= minor (m)
  Eigen::Vector2d direction{1, 0};  ///< of the major axis, unit

  [[nodiscard]] Eigen::Vector2d point(double s) const;
  /// s of the point that has the direction of x in the ellipse's own, unequally scaled, axes.
  [[nodiscard]] double anomaly(const Eigen::Vector2d& x) const;
};

/// An ellipse through drawn points and how well it is determined.
struct EllipseFit {
  Ellipse ellipse;
  double rms = 0, max = 0;  ///< distance of the points (m)
  double span = 0;          ///< part of the ellipse that the points cover, in s (rad)
  double condition = 0;     ///< as `CurveFit`, lengths in half axes
};

/// Least span of an arc that is taken for an ellipse (rad): 45 degrees. There, noise of a
/// thousandth of the major half axis on forty points changes the half axes by half of it (by the
/// linearised covariance, minor / major 0.6); at 30 degrees by three times it, at 90 degrees by 4
/// %.
inline constexpr double kLeastEllipseSpan = std::numbers::pi / 4;

/// Algebraic least squares with 4 a c - b^2 = 1, which only ellipses can meet: the start of
/// `fit_ellipse`. Biased towards small ellipses where points are noisy.
///
/// @param points  open or closed, in their order along the arc
/// @throws Error  naming `where`: fewer than five distinct points, points on a line; a general
///                conic that is a hyperbola and fits four times better
/// Source: Fitzgibbon, Pilu and Fisher 1999; numerically stable form of Halíř and Flusser 1998.
Ellipse direct_ellipse(const std::vector<Eigen::Vector2d>& points, const std::string& where);

/// Ellipse of least distance to the points, from the direct one (`fit_curve`).
/// @throws Error  as `direct_ellipse`; points that cover less than `kLeastEllipseSpan`
EllipseFit fit_ellipse(const std::vector<Eigen::Vector2d>& points, const std::string& where);

}  // namespace geoprior::sketch
