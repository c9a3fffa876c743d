#include "models/paper/shell/dynamics.h"

#include "models/paper/shell/step/hands.h"
#include "models/paper/shell/step/newton.h"
#include "models/paper/shell/step/soundness.h"

namespace geoprior::paper {

ShellDynamics::ShellDynamics(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                             const ShellState& state)
    : parts_(sheet, options, seed, state) {}

void ShellDynamics::step(const ShellState& state, double dt, Integration integration,
                         StepResult& result) {
  parts_.pose(state, dt);
  result.good = false;
  result.overshot = false;
  result.solves = 1;
  result.residual = 0;
  result.v.resize(vertices(), 3);
  Eigen::VectorXd change, reaction;
  const bool solved = linear_.solve(change, reaction);
  if (solved) {
    place(change, result);
  } else {
    result.x.resize(0, 3);
  }
  if (integration == Integration::newton) {
    if (!solve_newton(parts_, potential_, result, reaction)) return;
  } else if (!solved) {
    return;
  }
  if (!is_sound(elements(), state.x, result.x)) return;
  result.overshot = integration == Integration::linear &&
                    stretches(elements(), state.x, result.x) && overshoots(result.x);
  report_handles(parts_.sheet, parts_.problem, parts_.matrix, reaction, result);
  result.good = true;
}

void ShellDynamics::place(const Eigen::VectorXd& change, StepResult& result) const {
  const StepProblem& problem = parts_.problem;
  const ShellState& state = *problem.state;
  for (int i = 0; i < vertices(); ++i) {
    result.v.row(i) = state.v.row(i) + change.segment<3>(parts_.matrix.row(i)).transpose();
  }
  result.x = state.x + problem.dt * result.v;
  // Held vertices get their places themselves, not by way of the velocity: they would drift.
  for (const HandleMap::Target& t : problem.targets) result.x.row(t.vertex) = t.place.transpose();
}

/// Whether stretching alone takes more than all that the step began with, its handles moved. Where
/// nothing is strained the linear forces know no tension, and vertices that are pulled or pushed
/// sideways go much farther than the sheet reaches. (Bending does not count: the angle of a sharp
/// fold jumps from pi to -pi where the sheet passes through itself.)
bool ShellDynamics::overshoots(const Eigen::MatrixX3d& x) {
  const StepProblem& problem = parts_.problem;
  potential_.prepare();
  const double had = potential_.value(problem.held_still());
  ShellSystem::Sums sums;
  parts_.matrix.elastic().energy(elements(), *problem.state, x, sums);
  return !(problem.dt * problem.dt * sums.membrane <= had);
}

ShellEnergies ShellDynamics::energies(const ShellState& state) const {
  ShellSystem::Sums sums;
  parts_.matrix.elastic().energy(elements(), state, state.x, sums);
  ShellEnergies energies{.membrane = sums.membrane, .bending = sums.bending};
  for (int i = 0; i < vertices(); ++i) {
    energies.kinetic += parts_.mass[i] / 2 * state.v.row(i).squaredNorm();
    energies.gravity -= parts_.mass[i] * state.x.row(i).dot(parts_.sheet.gravity);
  }
  energies.contact = parts_.contact.energy(state.x, state.time);
  std::vector<HandleMap::Target> targets;
  handles().targets(parts_.sheet, state.time, targets);
  energies.hands = spring_energy(targets, state.x);
  return energies;
}

Eigen::MatrixX3d ShellDynamics::elastic_forces(const ShellState& state) const {
  ShellSystem::Sums sums;
  parts_.matrix.elastic().gradient(elements(), state, state.x, sums);
  Eigen::MatrixX3d forces(vertices(), 3);
  for (int i = 0; i < vertices(); ++i)
    forces.row(i) = -sums.gradient.segment<3>(parts_.matrix.row(i));
  return forces;
}

Eigen::MatrixX3d ShellDynamics::elastic_forces(const ShellState& state,
                                               const std::vector<int>& triangles) const {
  Eigen::MatrixX3d forces = Eigen::MatrixX3d::Zero(vertices(), 3);
  ShellElements::Local local;
  for (const int f : triangles) {
    elements().evaluate(f, state, state.x, ShellElements::Order::gradient, local);
    const auto nodes = elements().nodes(f);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      forces.row(nodes[k]) -= local.gradient.segment<3>(3 * k);
  }
  return forces;
}

}  // namespace geoprior::paper
