// Implicit Euler solved: the minimum over x, held vertices at their places, of
//   1/2 |x - x0 - dt v0 - dt^2 M^-1 loads|^2_M + dt^2 (E + contact + friction) + dt c/2 |x -
//   x0|^2_K
// by Newton's method with Hessians projected to positive semidefinite, corrected by the secants of
// the step's earlier iterations, and backtracking.
#include <algorithm>
#include <cmath>
#include <limits>

#include "baselines/paper/shell_dynamics.h"

namespace geoprior {
namespace {

/// Part of the decrease that the slope promises which a step must keep (Armijo).
constexpr double kLeastDecrease = 1e-4;
constexpr int kMostBacktracks = 20;
/// Iterations left to the projected Hessian alone, which is the better guide where it converges.
constexpr int kPatience = 6;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

bool ShellDynamics::solve_newton(Step& result, Eigen::VectorXd& reaction) {
  prepare_newton(result);
  SecantPairs secants;
  Eigen::VectorXd gradient, direction, before, step;
  Eigen::MatrixX3d trial;
  double value = potential(result.x);
  for (int solves = 0;; ++solves) {
    if (!std::isfinite(value)) return false;
    const double scale = potential_gradient(result.x, gradient);
    reaction = gradient / (problem_.dt * problem_.dt);
    for (const HandleMap::Target& t : problem_.targets)
      gradient.segment<3>(row(t.vertex)).setZero();
    if (solves >= kPatience) secants.remember(step, gradient - before);
    const double residual = gradient.norm();
    result.residual = scale > 0 ? residual / scale : 0;
    // What rounding of the positions alone leaves of the forces.
    const double floor = 4 * kEpsilon * result.x.cwiseAbs().maxCoeff() * matrix_.diagonal_norm();
    if (residual <= std::max(options_->newton_tolerance * scale, floor)) break;
    if (solves == options_->newton_iterations) return false;
    matrix_.take_out(problem_.held, taken_);
    if (!cholesky_->factorise(matrix_)) return false;
    ++result.solves;
    double length = 0;
    for (int attempt = 0; attempt < 2 && length == 0; ++attempt) {
      if (!find_direction(gradient, secants, direction)) return false;
      length = search_line(direction, gradient.dot(direction), result.x, value, trial);
      // Secants across a change of contact can mislead: once more without them.
      if (length == 0) secants.clear();
    }
    if (length == 0) return false;
    step = length * direction;
    before = gradient;
  }
  result.v = (result.x - problem_.state->x) / problem_.dt;
  return true;
}

/// The step to the minimum of the quadratic model; that of the projected Hessian alone where the
/// secants do not lead down.
bool ShellDynamics::find_direction(const Eigen::VectorXd& gradient, SecantPairs& secants,
                                   Eigen::VectorXd& direction) {
  const auto solve = [&](Eigen::VectorXd& b) {
    cholesky_->solve(b);
    return b.allFinite();
  };
  direction = -gradient;
  if (!secants.apply(direction, solve)) return false;
  if (gradient.dot(direction) < 0) return true;
  secants.clear();
  direction = -gradient;
  return solve(direction);
}

/// Starts where the potential is lower: the linear step's result, or the sheet at rest with its
/// handles moved.
void ShellDynamics::prepare_newton(Step& result) {
  const ShellState& state = *problem_.state;
  const double dt = problem_.dt;
  gather(state.x, problem_.start);
  problem_.inertial = problem_.start + dt * problem_.velocity;
  for (int i = 0; i < vertices(); ++i) {
    problem_.inertial.segment<3>(row(i)) += dt * dt / mass_[i] * problem_.loads.segment<3>(row(i));
  }
  if (sheet_->material.damping > 0) {
    damping_ = matrix_;
    damping_.set_zero();
    system_->hessian(elements_, state, state.x, dt * sheet_->material.damping, sums_, damping_);
  }
  Eigen::MatrixX3d still = state.x;
  for (const HandleMap::Target& t : problem_.targets) still.row(t.vertex) = t.place.transpose();
  const bool usable = result.x.rows() == still.rows() && result.x.allFinite();
  if (!usable || !(potential(result.x) <= potential(still))) result.x = still;
}

/// Moves `x` along the direction, as far as the potential falls. @return the part of it; 0: none
double ShellDynamics::search_line(const Eigen::VectorXd& direction, double slope,
                                  Eigen::MatrixX3d& x, double& value, Eigen::MatrixX3d& trial) {
  const double noise = 64 * kEpsilon * std::abs(value);
  double length = 1;
  for (int k = 0; k < kMostBacktracks; ++k, length /= 2) {
    trial = x;
    for (int i = 0; i < vertices(); ++i) {
      trial.row(i) += length * direction.segment<3>(row(i)).transpose();
    }
    const double tried = potential(trial);
    if (!(tried <= value + kLeastDecrease * length * slope + noise)) continue;
    x.swap(trial);
    value = tried;
    return length;
  }
  return 0;
}

double ShellDynamics::potential(const Eigen::MatrixX3d& x) {
  const double dt = problem_.dt;
  system_->energy(elements_, *problem_.state, x, sums_);
  double energy = sums_.membrane + sums_.bending;
  touching_.clear();
  for (const auto& term : contact_terms_) term->find({x, nullptr, problem_.time}, touching_);
  energy += contact_energy(touching_, options_->contact_distance);
  for (const FrictionPoint& friction : problem_.frictions) {
    energy += friction.limit * std::hypot(slip_of(friction, x).norm(), options_->creep_speed * dt);
  }
  double value = dt * dt * energy;
  for (int i = 0; i < vertices(); ++i) {
    value +=
        mass_[i] / 2 * (x.row(i).transpose() - problem_.inertial.segment<3>(row(i))).squaredNorm();
  }
  if (sheet_->material.damping > 0) {
    gather(x, right_);
    right_ -= problem_.start;
    damping_.multiply(right_, scratch_);
    value += right_.dot(scratch_) / 2;
  }
  return value;
}

/// Gradient of the potential, and its Hessian in the matrix. @return the largest of its terms
double ShellDynamics::potential_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const double dt = problem_.dt;
  matrix_.set_zero();
  system_->hessian(elements_, *problem_.state, x, dt * dt, sums_, matrix_);
  gradient = dt * dt * sums_.gradient;
  const double elastic = gradient.norm();
  gather(x, right_);
  if (sheet_->material.damping > 0) {
    scratch_ = right_ - problem_.start;
    Eigen::VectorXd force;
    damping_.multiply(scratch_, force);
    gradient += force;
    matrix_.add(damping_);
  }
  right_ -= problem_.inertial;
  for (int i = 0; i < vertices(); ++i) {
    right_.segment<3>(row(i)) *= mass_[i];
    matrix_.add_to_diagonal(position_[static_cast<std::size_t>(i)], mass_[i]);
  }
  gradient += right_;
  const double inertia = right_.norm();
  add_contact_gradient(x, gradient);
  add_friction_gradient(x, gradient);
  return std::max({elastic, inertia, dt * dt * problem_.loads.norm()});
}

void ShellDynamics::add_contact_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const double dt = problem_.dt;
  touching_.clear();
  for (const auto& term : contact_terms_) term->find({x, nullptr, problem_.time}, touching_);
  for (const ContactPoint& point : touching_) {
    const double push = point.stiffness * (options_->contact_distance - point.gap);
    add_contact_vector(point, -dt * dt * push * point.normal, gradient);
    add_contact_block(point, dt * dt * point.stiffness * point.normal * point.normal.transpose());
  }
}

void ShellDynamics::add_friction_gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient) {
  const double dt = problem_.dt;
  for (const FrictionPoint& friction : problem_.frictions) {
    const Eigen::Vector3d& n = friction.contact.normal;
    const Eigen::Vector3d slip = slip_of(friction, x);
    const double length = std::hypot(slip.norm(), options_->creep_speed * dt);
    const double factor = dt * dt * friction.limit / length;
    add_contact_vector(friction.contact, factor * slip, gradient);
    add_contact_block(friction.contact, factor * (Eigen::Matrix3d::Identity() - n * n.transpose() -
                                                  slip * slip.transpose() / (length * length)));
  }
}

/// How far a point has slid along the surface it touches, from the start of the step (m).
Eigen::Vector3d ShellDynamics::slip_of(const FrictionPoint& friction,
                                       const Eigen::MatrixX3d& x) const {
  const ContactPoint& point = friction.contact;
  Eigen::Vector3d moved = -problem_.dt * point.surface_velocity;
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
    const int i = point.vertex[k];
    moved += point.weight[k] * (x.row(i) - problem_.state->x.row(i)).transpose();
  }
  return moved - point.normal * point.normal.dot(moved);
}

}  // namespace geoprior
