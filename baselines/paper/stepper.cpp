#include "baselines/paper/stepper.h"

#include <string>

#include "baselines/paper/plasticity.h"
#include "baselines/paper/shell_dynamics.h"
#include "core/error.h"

namespace geoprior {

struct ShellStepper::Impl {
  Sheet sheet;
  StepperOptions options;
  std::uint64_t seed = 1;
  std::unique_ptr<ShellDynamics> dynamics;
  ShellDynamics::Step trial;

  [[nodiscard]] ShellDynamics& of(const ShellState& state) const;
  /// Steps by `dt`, in two halves (and so on) if need be; `whole` is the time asked for.
  void advance(ShellState& state, double dt, int halvings_left, double whole, StepReport& report);
};

ShellDynamics& ShellStepper::Impl::of(const ShellState& state) const {
  if (!dynamics) throw Error("no mesh was set", "ShellStepper", "set_mesh before the first step");
  if (state.x.rows() != dynamics->vertices() || state.v.rows() != dynamics->vertices() ||
      state.mesh.triangle_count() != dynamics->triangles() ||
      state.plastic_curvature.rows() != dynamics->triangles() ||
      state.damage.size() != dynamics->triangles()) {
    throw Error("the state does not fit the mesh that was set", "ShellStepper");
  }
  return *dynamics;
}

void ShellStepper::Impl::advance(ShellState& state, double dt, int halvings_left, double whole,
                                 StepReport& report) {
  dynamics->step(state, dt, trial);
  report.newton_iterations += trial.solves;
  if (!trial.good) {
    if (halvings_left == 0) {
      throw Error(
          "the step does not converge after " + std::to_string(options.most_halvings) + " halvings",
          "time " + std::to_string(state.time) + " s");
    }
    ++report.halvings;
    advance(state, dt / 2, halvings_left - 1, whole, report);
    advance(state, dt / 2, halvings_left - 1, whole, report);
    return;
  }
  state.x.swap(trial.x);
  state.v.swap(trial.v);
  state.time += dt;
  if (options.plasticity) {
    flow_plastically(dynamics->elements(), sheet.material.yield_curvature, state);
  }
  report.residual = std::max(report.residual, trial.residual);
  report.handle_work += trial.handle_work;
  for (std::size_t h = 0; h < trial.handle_force.size(); ++h) {
    report.handle_force[h] += dt / whole * trial.handle_force[h];
  }
}

ShellStepper::ShellStepper(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed)
    : impl_(std::make_unique<Impl>()) {
  impl_->sheet = sheet;
  impl_->options = options;
  impl_->seed = seed;
}

ShellStepper::~ShellStepper() = default;
ShellStepper::ShellStepper(ShellStepper&&) noexcept = default;
ShellStepper& ShellStepper::operator=(ShellStepper&&) noexcept = default;

void ShellStepper::set_mesh(const ShellState& state) {
  impl_->dynamics =
      std::make_unique<ShellDynamics>(impl_->sheet, impl_->options, impl_->seed, state);
}

StepReport ShellStepper::step(ShellState& state, double dt, RunContext& /*context*/) {
  static_cast<void>(impl_->of(state));
  if (!(dt > 0)) throw Error("step length " + std::to_string(dt), "ShellStepper", "above 0 s");
  StepReport report;
  report.handle_force.assign(impl_->sheet.handles.size(), Eigen::Vector3d::Zero());
  const ShellState before = state;
  try {
    impl_->advance(state, dt, impl_->options.most_halvings, dt, report);
  } catch (...) {
    state = before;
    throw;
  }
  // Not the sum of halved steps, so that times do not depend on what it took.
  state.time = before.time + dt;
  return report;
}

ShellEnergies ShellStepper::energies(const ShellState& state) const {
  return impl_->of(state).energies(state);
}

Eigen::MatrixX3d ShellStepper::elastic_forces(const ShellState& state) const {
  return impl_->of(state).elastic_forces(state);
}

Eigen::MatrixX3d ShellStepper::shape_operators(const ShellState& state) const {
  return geoprior::shape_operators(impl_->of(state).elements().curvature_fit(), state.x);
}

long ShellStepper::factor_nonzeros() const {
  return impl_->dynamics ? impl_->dynamics->factor_nonzeros() : 0;
}

std::vector<ShellStepper::Held> ShellStepper::held(double time) const {
  std::vector<Held> held;
  if (!impl_->dynamics) return held;
  std::vector<HandleMap::Target> targets;
  impl_->dynamics->handles().targets(impl_->sheet, time, targets);
  for (const HandleMap::Target& target : targets) held.push_back({target.vertex, target.handle});
  return held;
}

}  // namespace geoprior
