#pragma once

#include "core/options.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// How a sheet comes to rest on a mesh that has just been made.
struct SettleOptions {
  int steps = 20;
  double time = 1e-3;  ///< s
  double strain = 2e-4;
  double gain = 0.02;
};
void describe(OptionVisitor& v, SettleOptions& options);

/// The sheet gives way to its new mesh by steps from rest, which add no motion, until it is hardly
/// strained and a step releases hardly any energy. Without it the frame would record what the
/// change of the mesh has strained and bent, and the next steps would turn it into motion. Where
/// the sheet ends with more energy than it had, or with more strain than is little enough and than
/// it had (a linear step may overshoot), it stays as it was. @return steps taken
int settle(const Sheet& sheet, const SettleOptions& options, ShellStepper& stepper,
           ShellState& state);

}  // namespace geoprior::paper
