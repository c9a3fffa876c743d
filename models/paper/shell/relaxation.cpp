#include "models/paper/shell/relaxation.h"

#include <algorithm>

#include "core/error.h"

namespace geoprior::paper {
namespace {

constexpr int kTries = 4;
constexpr double kShorter = 4;
constexpr double kRounding = 1e-9;

double elastic_energy(const ShellStepper& stepper, const ShellState& state) {
  return stepper.energies(state).strain();
}

}  // namespace

Relaxation::Relaxation(double time, const ShellStepper& stepper, const ShellState& state)
    : full_(time), time_(time), energy_(elastic_energy(stepper, state)) {}

bool Relaxation::step(ShellStepper& stepper, ShellState& state) {
  const Eigen::MatrixX3d start = state.x;
  for (int i = 0; i < kTries; ++i) {
    try {
      stepper.relax(state, time_);
      const double energy = elastic_energy(stepper, state);
      if (energy <= (1 + kRounding) * energy_) {
        energy_ = energy;
        const bool whole = time_ == full_;
        time_ = std::min(kShorter * time_, full_);
        return whole;
      }
    } catch (const Error&) {
      // Too long as well.
    }
    state.x = start;
    time_ /= kShorter;
  }
  return false;
}

}  // namespace geoprior::paper
