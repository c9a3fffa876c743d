#include "models/paper/shell/step/contact.h"

namespace geoprior::paper {

StepContact::StepContact(const Sheet& sheet, const StepperOptions& options, const ShellMesh& mesh)
    : distance_(options.contact_distance) {
  if (sheet.obstacles.empty()) return;
  term_ = make_obstacle_contact(sheet.obstacles, mesh,
                                {.distance = options.contact_distance,
                                 .stiffness = options.contact_stiffness,
                                 .spacing = options.contact_spacing});
}

void StepContact::find(const StepProblem& problem, const Eigen::Vector3d& gravity) {
  found_.clear();
  if (!term_) return;
  const ShellState& state = *problem.state;
  ballistic_ = problem.dt * state.v;
  ballistic_.rowwise() += problem.dt * problem.dt * gravity.transpose();
  for (const HandleMap::Target& t : problem.targets) {
    ballistic_.row(t.vertex) = t.place.transpose() - state.x.row(t.vertex);
  }
  term_->find({state.x, &ballistic_, problem.time}, found_);
}

void StepContact::add_linear(const StepProblem& problem, StepMatrix& matrix,
                             Eigen::VectorXd& impulse) const {
  const double dt = problem.dt;
  for (const ContactPoint& point : found_) {
    const Eigen::Vector3d& n = point.normal;
    const double push = distance_ - point.gap - dt * n.dot(matrix.at(point, problem.velocity));
    matrix.add_block(point, dt * dt * point.stiffness * n * n.transpose());
    matrix.add_vector(point, dt * point.stiffness * push * n, impulse);
  }
}

std::vector<ContactPoint> StepContact::touching(const Eigen::MatrixX3d& x, double time) const {
  std::vector<ContactPoint> points;
  if (term_) term_->find({x, nullptr, time}, points);
  return points;
}

double StepContact::energy(const Eigen::MatrixX3d& x, double time) const {
  return contact_energy(touching(x, time), distance_);
}

void StepContact::add_gradient(const StepProblem& problem, const Eigen::MatrixX3d& x,
                               StepMatrix& matrix, Eigen::VectorXd& gradient) const {
  const double dt = problem.dt;
  for (const ContactPoint& point : touching(x, problem.time)) {
    const double push = point.stiffness * (distance_ - point.gap);
    matrix.add_vector(point, -dt * dt * push * point.normal, gradient);
    matrix.add_block(point, dt * dt * point.stiffness * point.normal * point.normal.transpose());
  }
}

}  // namespace geoprior::paper
