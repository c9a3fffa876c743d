#include "models/paper/shell/stepper.h"

#include <string>

#include "core/error.h"
#include "models/paper/shell/dynamics.h"
#include "models/paper/shell/plasticity.h"

namespace geoprior::paper {
namespace {

/// Of a step that does not converge, before the run ends; chosen: a 256th of a step that still does
/// not converge never will.
constexpr int kMostHalvings = 8;

}  // namespace

struct ShellStepper::Impl {
  Sheet sheet;
  StepperOptions options;
  std::uint64_t seed = 1;
  std::unique_ptr<ShellDynamics> dynamics;
  StepResult trial;

  [[nodiscard]] ShellDynamics& of(const ShellState& state) const;
  [[nodiscard]] StepReport empty_report() const {
    StepReport report;
    report.handle_force.assign(sheet.handles.size(), Eigen::Vector3d::Zero());
    return report;
  }
  struct Flow {
    bool plastic;
    bool may_overshoot;  ///< of relaxations: who asks for one compares the energies
    double whole;        ///< time asked for (s)
  };
  /// Steps by `dt`, in two halves (and so on) if need be.
  void advance(ShellState& state, double dt, int halvings_left, const Flow& flow,
               StepReport& report);
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

void ShellStepper::Impl::advance(ShellState& state, double dt, int halvings_left, const Flow& flow,
                                 StepReport& report) {
  const auto refused = [&](Integration integration) {
    dynamics->step(state, dt, integration, trial);
    report.newton_iterations += trial.solves;
    return !trial.good || (trial.overshot && !flow.may_overshoot);
  };
  // The last that is tried makes no energy: Newton's method goes downhill.
  const bool may_solve = halvings_left == 0 && options.integration != Integration::newton;
  if (refused(options.integration) &&
      (!may_solve || flow.may_overshoot || refused(Integration::newton))) {
    if (halvings_left == 0) {
      throw Error("the step does not converge after " + std::to_string(kMostHalvings) + " halvings",
                  "time " + std::to_string(state.time) + " s");
    }
    ++report.halvings;
    advance(state, dt / 2, halvings_left - 1, flow, report);
    advance(state, dt / 2, halvings_left - 1, flow, report);
    return;
  }
  state.x.swap(trial.x);
  state.v.swap(trial.v);
  state.time += dt;
  if (flow.plastic) {
    flow_plastically(dynamics->elements(), sheet.material.yield_curvature, state);
  }
  report.residual = std::max(report.residual, trial.residual);
  report.handle_work += trial.handle_work;
  for (std::size_t h = 0; h < trial.handle_force.size(); ++h) {
    report.handle_force[h] += dt / flow.whole * trial.handle_force[h];
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
  StepReport report = impl_->empty_report();
  const ShellState before = state;
  try {
    impl_->advance(state, dt, kMostHalvings, {impl_->options.plasticity, false, dt}, report);
  } catch (...) {
    state = before;
    throw;
  }
  // Times are not summed over halved steps, so that they do not depend on how many it took.
  state.time = before.time + dt;
  return report;
}

void ShellStepper::relax(ShellState& state, double dt) {
  static_cast<void>(impl_->of(state));
  ShellState rested = state;
  rested.v.setZero();
  rested.time = state.time - dt;
  StepReport report = impl_->empty_report();
  impl_->advance(rested, dt, kMostHalvings, {false, true, dt}, report);
  state.x.swap(rested.x);
}

ShellEnergies ShellStepper::energies(const ShellState& state) const {
  return impl_->of(state).energies(state);
}

Eigen::MatrixX3d ShellStepper::elastic_forces(const ShellState& state) const {
  return impl_->of(state).elastic_forces(state);
}

Eigen::MatrixX3d ShellStepper::elastic_forces(const ShellState& state,
                                              const std::vector<int>& triangles) const {
  return impl_->of(state).elastic_forces(state, triangles);
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

}  // namespace geoprior::paper
