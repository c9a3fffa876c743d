#pragma once

#include <Eigen/Core>

#include "models/paper/shell/secant_pairs.h"
#include "models/paper/shell/step/matrix.h"
#include "models/paper/shell/step/potential.h"

namespace geoprior::paper {

/// The step to the minimum of the quadratic model about a place: the factorised Hessian, corrected
/// by secants; without them, and they are forgotten, where they do not lead down.
/// @return  false where the solution is not finite
[[nodiscard]] bool find_direction(const Eigen::VectorXd& gradient, StepMatrix& matrix,
                                  SecantPairs& secants, Eigen::VectorXd& direction);

/// Where a minimisation is.
struct LineStart {
  Eigen::MatrixX3d& x;
  double& value;  ///< of the potential there
};

/// Moves along the direction as far as the potential falls, by backtracking (Armijo).
/// @param slope  of the potential along the direction
/// @param trial  overwritten
/// @return  the part of the direction; 0: none
double search_line(const StepMatrix& rows, const Eigen::VectorXd& direction, double slope,
                   StepPotential& potential, const LineStart& at, Eigen::MatrixX3d& trial);

}  // namespace geoprior::paper
