// One linear solve a step: (M + dt (dt + c) K + ...) (v1 - v0) = dt f - dt (dt + c) K v0 + ...
#include <cmath>

#include "baselines/paper/shell_dynamics.h"

namespace geoprior {

bool ShellDynamics::solve_linear(Eigen::VectorXd& change, Eigen::VectorXd& reaction) {
  const ShellState& state = *problem_.state;
  const double dt = problem_.dt;
  matrix_.set_zero();
  system_->hessian(elements_, state, state.x, dt * (dt + sheet_->material.damping), sums_, matrix_);
  matrix_.multiply(problem_.velocity, right_);
  right_ = dt * (problem_.loads - sums_.gradient) - right_;
  for (int i = 0; i < vertices(); ++i) {
    matrix_.add_to_diagonal(position_[static_cast<std::size_t>(i)], mass_[i]);
  }
  add_linear_contacts();
  change = right_;
  if (!solve_held(problem_.prescribed, change)) return false;
  reaction = -right_;
  multiply_taken(taken_, change, reaction);
  reaction /= dt;
  return true;
}

/// Contacts as linear springs that end at the contact distance, friction as a viscous force with
/// the coefficient that the expected slip has.
void ShellDynamics::add_linear_contacts() {
  const double dt = problem_.dt;
  const auto add = [&](const ContactPoint& point, const Eigen::Matrix3d& block,
                       const Eigen::Vector3d& impulse) {
    add_contact_block(point, block);
    add_contact_vector(point, impulse, right_);
  };
  const auto speed = [&](const ContactPoint& point) {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
      v += point.weight[k] * problem_.velocity.segment<3>(row(point.vertex[k]));
    }
    return v;
  };
  for (const ContactPoint& point : problem_.contacts) {
    const Eigen::Vector3d& n = point.normal;
    const double push = options_->contact_distance - point.gap - dt * n.dot(speed(point));
    add(point, dt * dt * point.stiffness * n * n.transpose(), dt * point.stiffness * push * n);
  }
  for (const FrictionPoint& friction : problem_.frictions) {
    const ContactPoint& point = friction.contact;
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - point.normal * point.normal.transpose();
    const Eigen::Vector3d slip = across * (speed(point) - point.surface_velocity);
    const double viscosity = friction.limit / std::hypot(friction.slip, options_->creep_speed);
    add(point, dt * viscosity * across, -dt * viscosity * slip);
  }
}

bool ShellDynamics::solve_held(const Eigen::VectorXd& prescribed, Eigen::VectorXd& solution) {
  matrix_.take_out(problem_.held, taken_);
  scratch_.setZero(solution.size());
  multiply_taken(taken_, prescribed, scratch_);
  solution -= scratch_;
  for (const HandleMap::Target& target : problem_.targets) {
    solution.segment<3>(row(target.vertex)) = prescribed.segment<3>(row(target.vertex));
  }
  if (!cholesky_->factorise(matrix_)) return false;
  cholesky_->solve(solution);
  return solution.allFinite();
}

}  // namespace geoprior
