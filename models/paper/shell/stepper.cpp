#include "models/paper/shell/stepper.h"

#include <array>
#include <string>
#include <string_view>

#include "core/error.h"
#include "models/paper/shell/dynamics.h"
#include "models/paper/shell/plasticity.h"

namespace geoprior::paper {

struct ShellStepper::Impl {
  Sheet sheet;
  StepperOptions options;
  std::uint64_t seed = 1;
  std::unique_ptr<ShellDynamics> dynamics;
  ShellDynamics::Step trial;

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
      throw Error(
          "the step does not converge after " + std::to_string(options.most_halvings) + " halvings",
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
    impl_->advance(state, dt, impl_->options.most_halvings, {impl_->options.plasticity, false, dt},
                   report);
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
  impl_->advance(rested, dt, impl_->options.most_halvings, {false, true, dt}, report);
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

namespace {

constexpr std::array<std::string_view, 2> kBendingNames{"shape-operator", "hinge"};
constexpr std::array<std::string_view, 2> kIntegrationNames{"linear", "newton"};
constexpr std::array<std::string_view, 4> kSolverNames{"automatic", "eigen", "cholmod",
                                                       "supernodal"};

void describe_contact(OptionVisitor& v, StepperOptions& o) {
  v.value("contact_distance", o.contact_distance,
          {.doc = "gap at which an obstacle begins to push", .unit = "m", .min = 1e-6, .max = 0.1});
  v.value("contact_stiffness", o.contact_stiffness,
          {.doc = "of the push, per area of sheet", .unit = "N/m^3", .min = 1, .max = 1e12});
  v.value("contact_spacing", o.contact_spacing,
          {.doc = "distance of the points of a triangle that are tested against obstacles",
           .unit = "m",
           .min = 1e-4,
           .max = 10});
  v.value("creep_speed", o.creep_speed,
          {.doc = "slip speed at which friction reaches 0.7 of Coulomb's",
           .unit = "m/s",
           .min = 1e-9,
           .max = 1});
}

}  // namespace

void describe(OptionVisitor& v, StepperOptions& o) {
  describe_choice(v, "integration", o.integration, kIntegrationNames,
                  {.doc = "one linear solve a step, or implicit Euler solved by Newton"});
  describe_choice(v, "bending", o.bending.model, kBendingNames,
                  {.doc = "plate energy of the shape operator, or hinges"});
  v.value("hinge_calibration", o.bending.hinge_calibration,
          {.doc = "factor of the hinge energy", .min = 1e-3, .max = 1e3});
  v.value("fit_residual", o.bending.fit_residual,
          {.doc = "stiffness against angles at borders and folds that the fitted curvature leaves, "
                  "relative to the plate's",
           .min = 1e-6,
           .max = 10});
  v.value("plasticity", o.plasticity,
          {.doc = "the sheet creases where its elastic curvature exceeds the material's yield"});
  v.value("newton_iterations", o.newton_iterations,
          {.doc = "most linear solves of a step", .min = 1, .max = 1000});
  v.value("newton_tolerance", o.newton_tolerance,
          {.doc = "residual relative to the forces of the step", .min = 1e-14, .max = 1});
  v.value("most_halvings", o.most_halvings,
          {.doc = "of a step that does not converge, before the run ends", .min = 0, .max = 30});
  describe_choice(v, "solver", o.solver, kSolverNames, {.doc = "sparse factorisation"});
  v.value("dissection_from", o.dissection_from,
          {.doc = "triangles from which unknowns are ordered by nested dissection, not by degree",
           .min = 0,
           .max = 1e9});
  describe_contact(v, o);
}

}  // namespace geoprior::paper
