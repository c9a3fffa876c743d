#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/sheet/handle_map.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/step/matrix.h"
#include "models/paper/shell/step/problem.h"
#include "models/paper/shell/step/result.h"

namespace geoprior::paper {

/// Of the hands that give among the targets, springs k (y - x) to the place y that each wants (J).
double spring_energy(const std::vector<HandleMap::Target>& targets, const Eigen::MatrixX3d& x);

/// Springs of a step, implicit in both ends.
void add_linear_springs(const StepProblem& problem, StepMatrix& matrix, Eigen::VectorXd& impulse);

/// dt^2 times gradient and Hessian of the springs' energy.
void add_spring_gradient(const StepProblem& problem, const Eigen::MatrixX3d& x, StepMatrix& matrix,
                         Eigen::VectorXd& gradient);

/// Forces of the handles on the sheet and the work that prescribed ones have done, after a step.
/// @param reaction  of held vertices, in solver order (N)
void report_handles(const Sheet& sheet, const StepProblem& problem, const StepMatrix& rows,
                    const Eigen::VectorXd& reaction, StepResult& result);

}  // namespace geoprior::paper
