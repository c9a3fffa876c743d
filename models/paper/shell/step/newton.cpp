#include "models/paper/shell/step/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/paper/shell/secant_pairs.h"
#include "models/paper/shell/step/line_search.h"

namespace geoprior::paper {
namespace {

/// Iterations left to the projected Hessian alone, which is the better guide where it converges.
constexpr int kPatience = 6;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

void choose_start(const StepProblem& problem, StepPotential& potential, StepResult& result) {
  const Eigen::MatrixX3d still = problem.held_still();
  const bool usable = result.x.rows() == still.rows() && result.x.allFinite();
  if (!usable || !(potential.value(result.x) <= potential.value(still))) result.x = still;
}

/// One iteration from a factorised Hessian. @return the part of the direction taken; 0: none
double descend(StepParts& parts, StepPotential& potential, const Eigen::VectorXd& gradient,
               SecantPairs& secants, const LineStart& at, Eigen::VectorXd& direction,
               Eigen::MatrixX3d& trial) {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (!find_direction(gradient, parts.matrix, secants, direction)) return 0;
    const double length =
        search_line(parts.matrix, direction, gradient.dot(direction), potential, at, trial);
    if (length != 0) return length;
    // Secants across a change of contact can mislead: once more without them.
    secants.clear();
  }
  return 0;
}

}  // namespace

bool solve_newton(StepParts& parts, StepPotential& potential, StepResult& result,
                  Eigen::VectorXd& reaction) {
  const StepProblem& problem = parts.problem;
  StepMatrix& matrix = parts.matrix;
  potential.prepare();
  choose_start(problem, potential, result);
  SecantPairs secants;
  Eigen::VectorXd gradient, direction, before, step;
  Eigen::MatrixX3d trial;
  double value = potential.value(result.x);
  for (int solves = 0;; ++solves) {
    if (!std::isfinite(value)) return false;
    const double scale = potential.gradient(result.x, gradient);
    reaction = gradient / (problem.dt * problem.dt);
    for (const HandleMap::Target& t : problem.targets)
      gradient.segment<3>(matrix.row(t.vertex)).setZero();
    if (solves >= kPatience) secants.remember(step, gradient - before);
    const double residual = gradient.norm();
    result.residual = scale > 0 ? residual / scale : 0;
    // What rounding of the positions alone leaves of the forces.
    const double floor =
        4 * kEpsilon * result.x.cwiseAbs().maxCoeff() * matrix.blocks().diagonal_norm();
    if (residual <= std::max(parts.options.newton_tolerance * scale, floor)) break;
    if (solves == parts.options.newton_iterations) return false;
    matrix.take_out(problem.held);
    if (!matrix.factorise()) return false;
    ++result.solves;
    const double length =
        descend(parts, potential, gradient, secants, {result.x, value}, direction, trial);
    if (length == 0) return false;
    step = length * direction;
    before = gradient;
  }
  result.v = (result.x - problem.state->x) / problem.dt;
  return true;
}

}  // namespace geoprior::paper
