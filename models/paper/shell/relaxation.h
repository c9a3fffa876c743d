#pragma once

#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// Implicit steps of a sheet from rest, towards rest. One that raises the elastic energy is too
/// long for its linear forces, and is tried again shorter; those after it grow again.
class Relaxation {
 public:
  /// @param time  of a step (s)
  Relaxation(double time, const ShellStepper& stepper, const ShellState& state);
  [[nodiscard]] double energy() const { return energy_; }  ///< elastic, of the last state (J)
  /// @return  whether the sheet could take a step of full length
  bool step(ShellStepper& stepper, ShellState& state);

 private:
  double full_, time_;  // s
  double energy_;       // J
};

}  // namespace geoprior::paper
