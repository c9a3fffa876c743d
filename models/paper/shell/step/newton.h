#pragma once

#include <Eigen/Core>

#include "models/paper/shell/step/parts.h"
#include "models/paper/shell/step/potential.h"
#include "models/paper/shell/step/result.h"

namespace geoprior::paper {

/// Implicit Euler solved: minimises the potential by Newton's method with Hessians projected to
/// positive semidefinite, corrected by the secants of the step's earlier iterations, and
/// backtracking.
///
/// Starts where the potential is lower: at the result of the linear step, if it has one, or at the
/// sheet at rest with its handles moved.
/// @param result    takes positions, velocities, residual and the number of solves
/// @param reaction  of held vertices, in solver order (N)
/// @return  whether it has converged
[[nodiscard]] bool solve_newton(StepParts& parts, StepPotential& potential, StepResult& result,
                                Eigen::VectorXd& reaction);

}  // namespace geoprior::paper
