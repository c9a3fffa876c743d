#pragma once

#include "models/paper/shell_state.h"
#include "models/paper/stepper.h"

namespace geoprior::paper {

inline StepperOptions without_plasticity(StepperOptions options) {
  options.plasticity = false;
  return options;
}

/// An implicit step from rest with the handles where they are now: the sheet gives way, and its
/// time stays.
/// @throws Error  when the step does not converge
inline void relax(ShellStepper& stepper, double dt, ShellState& state, RunContext& context) {
  const double now = state.time;
  state.v.setZero();
  state.time = now - dt;
  static_cast<void>(stepper.step(state, dt, context));
  state.time = now;
}

}  // namespace geoprior::paper
