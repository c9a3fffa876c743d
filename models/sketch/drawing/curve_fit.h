#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace geoprior::sketch {

/// A family of plane curves p(s) = c + a cos s + b sin s: ellipses, and circles in space as a view
/// shows them.
///
/// `columns` are c, a, b as functions of the parameters; `derivatives` has a row for each of their
/// six coordinates (c.x, c.y, a.x, …) and a column a parameter.
using ConjugateCurve =
    std::function<void(const Eigen::VectorXd& parameters, Eigen::Matrix<double, 2, 3>& columns,
                       Eigen::Matrix<double, 6, Eigen::Dynamic>& derivatives)>;

/// A curve of a family that lies nearest to points.
struct CurveFit {
  Eigen::VectorXd parameters;
  std::vector<double> at;  ///< s of the nearest point of the curve, one for each point (rad)
  double rms = 0;          ///< distance of the points from the curve
  double max = 0;
  /// Greatest over least singular value of the derivative of the points' distances by the free
  /// parameters: by how much noise of the points is enlarged. Parameters are best of like size; 1
  /// without a free one.
  double condition = 0;
};

/// Orthogonal distance fit: minimises sum |p(s_i) - q_i|^2 over the parameters and all s_i.
///
/// Levenberg–Marquardt with exact derivatives; the s_i, of which each point has its own, are
/// eliminated first (Schur complement). One thread, so that the result is the same everywhere.
///
/// @param points  about of size 1 and about the origin, for the sake of the solver's tolerances
/// @param start   parameters, and `at` s of each point
/// @param fixed   parameters that keep their start
/// @param where   for errors
/// @throws Error  when the solver fails
/// Source: Ahn, Rauh and Warnecke 2001 (distance fitting); Ceres Solver 2.1.
CurveFit fit_curve(const ConjugateCurve& curve, const std::vector<Eigen::Vector2d>& points,
                   const Eigen::VectorXd& start, const std::vector<double>& at,
                   const std::vector<int>& fixed, const std::string& where);

}  // namespace geoprior::sketch
