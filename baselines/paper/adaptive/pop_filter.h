#pragma once

#include <vector>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// Removes the jump in elastic force that remeshing leaves (Narain, Pfaff, O'Brien 2013, the pop
/// filter): moves the vertices with other triangles than before to where the elastic forces are
/// what they were,
///   minimise  E(x) - sum f_i . x_i + mu/2 sum m_i |x_i - x0_i|^2,
/// f minus the elastic force of the old mesh per area, linear on its triangles, times the new area.
/// A few Newton steps, shortened while the objective grows. Velocities stay.
///
/// @param before   state and elastic forces (n x 3, N) before remeshing
/// @param changed  of the vertices of `state`
/// @param held     vertices that do not move
/// @return  Newton steps taken
int filter_pops(const Sheet& sheet, const StepperOptions& options, const ShellState& before,
                const Eigen::MatrixX3d& forces, const std::vector<bool>& changed,
                const std::vector<int>& held, ShellState& state);

}  // namespace geoprior::paper
