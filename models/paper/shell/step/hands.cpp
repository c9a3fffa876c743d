#include "models/paper/shell/step/hands.h"

#include <algorithm>

namespace geoprior::paper {

double spring_energy(const std::vector<HandleMap::Target>& targets, const Eigen::MatrixX3d& x) {
  double energy = 0;
  for (const HandleMap::Target& t : targets) {
    if (t.stiffness)
      energy += *t.stiffness / 2 * (x.row(t.vertex).transpose() - t.place).squaredNorm();
  }
  return energy;
}

void add_linear_springs(const StepProblem& problem, StepMatrix& matrix, Eigen::VectorXd& impulse) {
  const double dt = problem.dt;
  for (const HandleMap::Target& t : problem.springs) {
    const Eigen::Index row = matrix.row(t.vertex);
    const Eigen::Vector3d x = problem.state->x.row(t.vertex);
    const Eigen::Vector3d stretch = t.place - x - dt * problem.velocity.segment<3>(row);
    impulse.segment<3>(row) += dt * *t.stiffness * stretch;
    matrix.add_to_diagonal(t.vertex, dt * dt * *t.stiffness);
  }
}

void add_spring_gradient(const StepProblem& problem, const Eigen::MatrixX3d& x, StepMatrix& matrix,
                         Eigen::VectorXd& gradient) {
  for (const HandleMap::Target& t : problem.springs) {
    const double stiffness = problem.dt * problem.dt * *t.stiffness;
    gradient.segment<3>(matrix.row(t.vertex)) +=
        stiffness * (x.row(t.vertex).transpose() - t.place);
    matrix.add_to_diagonal(t.vertex, stiffness);
  }
}

void report_handles(const Sheet& sheet, const StepProblem& problem, const StepMatrix& rows,
                    const Eigen::VectorXd& reaction, StepResult& result) {
  result.handle_force.assign(sheet.handles.size(), Eigen::Vector3d::Zero());
  result.handle_work = 0;
  for (const HandleMap::Target& t : problem.targets) {
    const Eigen::Vector3d force = reaction.segment<3>(rows.row(t.vertex));
    const Eigen::Vector3d from = problem.state->x.row(t.vertex);
    result.handle_force[t.handle] += force;
    result.handle_work += force.dot(t.place - from);
  }
  for (const HandleMap::Target& t : problem.springs) {
    const Eigen::Vector3d to = result.x.row(t.vertex);
    const Eigen::Vector3d force = *t.stiffness * (t.place - to);
    result.handle_force[t.handle] += force;
    // By its own way: the spring between is part of what it moves.
    const auto before = std::find_if(
        problem.springs_before.begin(), problem.springs_before.end(),
        [&](const HandleMap::Target& b) { return b.vertex == t.vertex && b.handle == t.handle; });
    if (before != problem.springs_before.end())
      result.handle_work += force.dot(t.place - before->place);
  }
  for (std::size_t h = 0; h < sheet.handles.size(); ++h) {
    const Handle& handle = sheet.handles[h];
    if (handle.force && handle.is_active(problem.time)) result.handle_force[h] = *handle.force;
  }
}

}  // namespace geoprior::paper
