#include "solvers/paper/settled_energy.h"

#include <limits>

#include "core/error.h"
#include "solvers/paper/relaxation.h"

namespace geoprior::paper {
namespace {

constexpr int kSteps = 3;
constexpr double kStep = 0.005;  // s, of the length of a usual step

}  // namespace

double settled_energy(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                      ShellState state, RunContext& context) {
  ShellStepper stepper(sheet, without_plasticity(options), seed);
  try {
    stepper.set_mesh(state);
    for (int k = 0; k < kSteps; ++k) relax(stepper, kStep, state, context);
  } catch (const Error&) {
    return std::numeric_limits<double>::infinity();
  }
  const ShellEnergies energies = stepper.energies(state);
  return energies.membrane + energies.bending;
}

}  // namespace geoprior::paper
