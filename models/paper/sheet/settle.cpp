#include "models/paper/sheet/settle.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace geoprior::paper {
namespace {

struct Tension {
  double energy = 0;  ///< elastic (J)
  double strain = 0;  ///< root mean square, as the membrane energy counts it
};

Tension tension(const Sheet& sheet, const ShellStepper& stepper, const ShellState& state) {
  const ShellEnergies energies = stepper.energies(state);
  const double stiffness = sheet.material.membrane_stiffness() * signed_area(sheet.pattern);
  return {energies.strain(), std::sqrt(2 * energies.membrane / stiffness)};
}

}  // namespace

void describe(OptionVisitor& v, SettleOptions& o) {
  v.value(
      "steps", o.steps,
      {.doc = "most implicit steps from rest after a new mesh; 0: none", .min = 0, .max = 1000});
  v.value("time", o.time,
          {.doc = "length of an implicit step in which a new mesh settles",
           .unit = "s",
           .min = 1e-9,
           .max = 10});
  v.value("strain", o.strain,
          {.doc = "root mean square of the strain at which a new mesh has settled",
           .min = 1e-12,
           .max = 1});
  v.value(
      "gain", o.gain,
      {.doc = "part of the elastic energy that an implicit step must release for another to follow",
       .min = 0,
       .max = 1});
}

int settle(const Sheet& sheet, const SettleOptions& options, ShellStepper& stepper,
           ShellState& state) {
  if (options.steps == 0) return 0;
  const Tension start = tension(sheet, stepper, state);
  const Eigen::MatrixX3d before = state.x;
  Tension now = start;
  int steps = 0;
  for (bool settled = false; !settled && steps < options.steps; ++steps) {
    try {
      stepper.relax(state, options.time);
    } catch (const Error&) {
      break;
    }
    const Tension last = now;
    now = tension(sheet, stepper, state);
    settled = now.strain <= options.strain && now.energy >= (1 - options.gain) * last.energy;
  }
  if (now.energy > start.energy || now.strain > std::max(start.strain, options.strain)) {
    state.x = before;
  }
  return steps;
}

}  // namespace geoprior::paper
