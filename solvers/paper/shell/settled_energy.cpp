#include "solvers/paper/shell/settled_energy.h"

#include <limits>

#include "core/error.h"

namespace geoprior::paper {
namespace {

constexpr int kSteps = 3;
constexpr double kUsualStep = 0.005;  // s, of the length of a usual step

}  // namespace

double settled_energy(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                      ShellState state) {
  ShellStepper stepper(sheet, options, seed);
  try {
    stepper.set_mesh(state);
    for (int k = 0; k < kSteps; ++k) stepper.relax(state, kUsualStep);
  } catch (const Error&) {
    return std::numeric_limits<double>::infinity();
  }
  return stepper.energies(state).strain();
}

}  // namespace geoprior::paper
