#include "models/paper/shell/step/problem.h"

#include <algorithm>
#include <iterator>

namespace geoprior::paper {

void StepProblem::pose(const Sheet& sheet, const HandleMap& handles, const Eigen::VectorXd& mass,
                       const StepMatrix& rows, const ShellState& start, double length) {
  state = &start;
  dt = length;
  time = start.time + dt;
  rows.gather(start.v, velocity);
  Eigen::MatrixX3d forces = mass * sheet.gravity.transpose();
  handles.add_loads(sheet, time, forces);
  rows.gather(forces, loads);
  handles.targets(sheet, time, targets);
  const auto gives = [](const HandleMap::Target& t) { return t.stiffness.has_value(); };
  springs.clear();
  std::copy_if(targets.begin(), targets.end(), std::back_inserter(springs), gives);
  std::erase_if(targets, gives);
  springs_before.clear();
  if (!springs.empty()) handles.targets(sheet, start.time, springs_before);
  held.assign(start.x.rows(), 0);
  prescribed.setZero(velocity.size());
  for (const HandleMap::Target& target : targets) {
    held[rows.position(target.vertex)] = 1;
    const Eigen::Vector3d move = target.place - start.x.row(target.vertex).transpose();
    prescribed.segment<3>(rows.row(target.vertex)) =
        move / dt - start.v.row(target.vertex).transpose();
  }
}

Eigen::MatrixX3d StepProblem::held_still() const {
  Eigen::MatrixX3d still = state->x;
  for (const HandleMap::Target& t : targets) still.row(t.vertex) = t.place.transpose();
  return still;
}

}  // namespace geoprior::paper
