#include "models/paper/shell/step/friction.h"

#include <algorithm>
#include <cmath>

namespace geoprior::paper {
namespace {

/// How far a point has slid along the surface it touches, from the start of the step (m).
Eigen::Vector3d slip_of(const ContactPoint& point, const StepProblem& problem,
                        const Eigen::MatrixX3d& x) {
  Eigen::Vector3d moved = -problem.dt * point.surface_velocity;
  for (int k = 0; k < point.count; ++k) {
    const int i = point.vertex[k];
    moved += point.weight[k] * (x.row(i) - problem.state->x.row(i)).transpose();
  }
  return moved - point.normal * point.normal.dot(moved);
}

}  // namespace

StepFriction::StepFriction(const Sheet& sheet, const StepperOptions& options)
    : coefficient_(sheet.material.friction),
      area_density_(sheet.material.area_density),
      contact_distance_(options.contact_distance),
      contact_stiffness_(options.contact_stiffness),
      creep_speed_(options.creep_speed) {}

void StepFriction::find(const StepProblem& problem, const StepContact& contact) {
  points_.clear();
  if (!(coefficient_ > 0)) return;
  for (const ContactPoint& point : contact.found()) {
    // The gap at the start of the step: the obstacle moves meanwhile.
    const double gap = point.gap + problem.dt * point.normal.dot(point.surface_velocity);
    const double push = point.stiffness * (contact_distance_ - gap);
    if (!(push > 0)) continue;
    const double limit = coefficient_ * push;
    points_.push_back({point, limit, expected_slip(problem, contact.ballistic(), point, limit)});
  }
}

/// Slip speed of a point at the end of the step as far as it is known before the solve: the present
/// one, or that of free flight slowed by friction, whichever is faster.
double StepFriction::expected_slip(const StepProblem& problem, const Eigen::MatrixX3d& ballistic,
                                   const ContactPoint& point, double limit) const {
  Eigen::Vector3d now = -point.surface_velocity, flying = now;
  for (int k = 0; k < point.count; ++k) {
    now += point.weight[k] * problem.state->v.row(point.vertex[k]).transpose();
    flying += point.weight[k] / problem.dt * ballistic.row(point.vertex[k]).transpose();
  }
  const auto across = [&](const Eigen::Vector3d& v) {
    return (v - point.normal * point.normal.dot(v)).norm();
  };
  const double mass = point.stiffness / contact_stiffness_ * area_density_;
  return std::max(across(now), across(flying) - problem.dt * limit / mass);
}

void StepFriction::add_linear(const StepProblem& problem, StepMatrix& matrix,
                              Eigen::VectorXd& impulse) const {
  const double dt = problem.dt;
  for (const FrictionPoint& friction : points_) {
    const ContactPoint& point = friction.contact;
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - point.normal * point.normal.transpose();
    const Eigen::Vector3d slip =
        across * (matrix.at(point, problem.velocity) - point.surface_velocity);
    const double viscosity = friction.limit / std::hypot(friction.slip, creep_speed_);
    matrix.add_block(point, dt * viscosity * across);
    matrix.add_vector(point, -dt * viscosity * slip, impulse);
  }
}

void StepFriction::add_energy(const StepProblem& problem, const Eigen::MatrixX3d& x,
                              double& energy) const {
  for (const FrictionPoint& friction : points_) {
    const double slip = slip_of(friction.contact, problem, x).norm();
    energy += friction.limit * std::hypot(slip, creep_speed_ * problem.dt);
  }
}

void StepFriction::add_gradient(const StepProblem& problem, const Eigen::MatrixX3d& x,
                                StepMatrix& matrix, Eigen::VectorXd& gradient) const {
  const double dt = problem.dt;
  for (const FrictionPoint& friction : points_) {
    const Eigen::Vector3d& n = friction.contact.normal;
    const Eigen::Vector3d slip = slip_of(friction.contact, problem, x);
    const double length = std::hypot(slip.norm(), creep_speed_ * dt);
    const double factor = dt * dt * friction.limit / length;
    matrix.add_vector(friction.contact, factor * slip, gradient);
    matrix.add_block(friction.contact, factor * (Eigen::Matrix3d::Identity() - n * n.transpose() -
                                                 slip * slip.transpose() / (length * length)));
  }
}

}  // namespace geoprior::paper
