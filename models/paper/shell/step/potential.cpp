#include "models/paper/shell/step/potential.h"

#include <algorithm>

#include "models/paper/shell/step/hands.h"

namespace geoprior::paper {

void StepPotential::prepare() {
  const StepProblem& problem = parts_.problem;
  const ShellState& state = *problem.state;
  const StepMatrix& matrix = parts_.matrix;
  const double dt = problem.dt, damping = parts_.sheet.material.damping;
  matrix.gather(state.x, start_);
  inertial_ = start_ + dt * problem.velocity;
  for (int i = 0; i < parts_.vertices(); ++i) {
    const Eigen::Index row = matrix.row(i);
    inertial_.segment<3>(row) += dt * dt / parts_.mass[i] * problem.loads.segment<3>(row);
  }
  if (damping > 0) {
    damping_ = parts_.matrix.blocks();
    damping_.set_zero();
    matrix.elastic().hessian(parts_.elements, state, state.x, dt * damping, sums_, damping_);
  }
}

double StepPotential::value(const Eigen::MatrixX3d& x) {
  const StepProblem& problem = parts_.problem;
  const StepMatrix& matrix = parts_.matrix;
  const double dt = problem.dt;
  matrix.elastic().energy(parts_.elements, *problem.state, x, sums_);
  double energy = sums_.membrane + sums_.bending;
  energy += parts_.contact.energy(x, problem.time);
  parts_.friction.add_energy(problem, x, energy);
  energy += spring_energy(problem.springs, x);
  double value = dt * dt * energy;
  for (int i = 0; i < parts_.vertices(); ++i) {
    value += parts_.mass[i] / 2 *
             (x.row(i).transpose() - inertial_.segment<3>(matrix.row(i))).squaredNorm();
  }
  if (parts_.sheet.material.damping > 0) {
    matrix.gather(x, moved_);
    moved_ -= start_;
    damping_.multiply(moved_, scratch_);
    value += moved_.dot(scratch_) / 2;
  }
  return value;
}

double StepPotential::gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const StepProblem& problem = parts_.problem;
  StepMatrix& matrix = parts_.matrix;
  const double dt = problem.dt;
  matrix.blocks().set_zero();
  matrix.elastic().hessian(parts_.elements, *problem.state, x, dt * dt, sums_, matrix.blocks());
  gradient = dt * dt * sums_.gradient;
  const double elastic = gradient.norm();
  matrix.gather(x, moved_);
  if (parts_.sheet.material.damping > 0) {
    scratch_ = moved_ - start_;
    Eigen::VectorXd force;
    damping_.multiply(scratch_, force);
    gradient += force;
    matrix.blocks().add(damping_);
  }
  moved_ -= inertial_;
  for (int i = 0; i < parts_.vertices(); ++i) {
    moved_.segment<3>(matrix.row(i)) *= parts_.mass[i];
    matrix.add_to_diagonal(i, parts_.mass[i]);
  }
  gradient += moved_;
  const double inertia = moved_.norm();
  parts_.contact.add_gradient(problem, x, matrix, gradient);
  parts_.friction.add_gradient(problem, x, matrix, gradient);
  add_spring_gradient(problem, x, matrix, gradient);
  return std::max({elastic, inertia, dt * dt * problem.loads.norm()});
}

}  // namespace geoprior::paper
