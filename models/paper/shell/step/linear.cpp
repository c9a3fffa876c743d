#include "models/paper/shell/step/linear.h"

#include "models/paper/shell/step/hands.h"

namespace geoprior::paper {

bool LinearStep::solve(Eigen::VectorXd& change, Eigen::VectorXd& reaction) {
  assemble();
  change = right_;
  if (!solve_held(change)) return false;
  reaction = -right_;
  parts_.matrix.multiply_taken(change, reaction);
  reaction /= parts_.problem.dt;
  return true;
}

void LinearStep::assemble() {
  const StepProblem& problem = parts_.problem;
  const ShellState& state = *problem.state;
  const double dt = problem.dt;
  StepMatrix& matrix = parts_.matrix;
  matrix.blocks().set_zero();
  matrix.elastic().hessian(parts_.elements, state, state.x,
                           dt * (dt + parts_.sheet.material.damping), sums_, matrix.blocks());
  matrix.blocks().multiply(problem.velocity, right_);
  right_ = dt * (problem.loads - sums_.gradient) - right_;
  for (int i = 0; i < parts_.vertices(); ++i) matrix.add_to_diagonal(i, parts_.mass[i]);
  parts_.contact.add_linear(problem, matrix, right_);
  parts_.friction.add_linear(problem, matrix, right_);
  add_linear_springs(problem, matrix, right_);
}

bool LinearStep::solve_held(Eigen::VectorXd& solution) {
  const StepProblem& problem = parts_.problem;
  StepMatrix& matrix = parts_.matrix;
  matrix.take_out(problem.held);
  scratch_.setZero(solution.size());
  matrix.multiply_taken(problem.prescribed, scratch_);
  solution -= scratch_;
  for (const HandleMap::Target& target : problem.targets) {
    const Eigen::Index row = matrix.row(target.vertex);
    solution.segment<3>(row) = problem.prescribed.segment<3>(row);
  }
  return matrix.factorise() && matrix.solve(solution);
}

}  // namespace geoprior::paper
