#pragma once

#include <memory>

#include "core/method.h"
#include "core/state_bytes.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// What distinguishes the methods of the topic: who makes the mesh, and how it changes.
class SheetMesher {
 public:
  virtual ~SheetMesher() = default;
  /// Mesh and state at t = 0: every anchor of every handle is a vertex.
  [[nodiscard]] virtual ShellState start(const Sheet& sheet, RunContext& context) = 0;
  /// Called after every step: tears grow here. The stepper is given every new mesh.
  virtual void stepped(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& /*state*/,
                       RunContext& /*context*/) {}
  /// Called after the substeps of a frame; true when the connectivity changed (the stepper then
  /// analyses it anew). Marks its own phases.
  virtual bool adapt(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
                     RunContext& context) = 0;
  /// Called after a change of the connectivity, once the stepper has taken it up: takes back what
  /// the change has strained. Marks its own phases.
  /// @return  false: the change is to be taken back
  virtual bool settle(const Sheet& /*sheet*/, ShellStepper& /*stepper*/, ShellState& /*state*/,
                      RunContext& /*context*/) {
    return true;
  }
  /// Undoes the last `adapt`, which moves the sheet too far or from whose mesh it cannot go on.
  /// @return  false: the state stays as it is
  virtual bool take_back(const Sheet& /*sheet*/, ShellState& /*state*/, RunContext& /*context*/) {
    return false;
  }
  /// Adds parts, arrays, tables and diagnostics of its own ("rulings", "singular_points" …).
  virtual void annotate(const ShellState& state, Frame& frame) const = 0;
  /// Everything that `adapt` and `annotate` remember from one frame to the next, for checkpoints.
  virtual void save(StateWriter& /*out*/) const {}
  virtual void load(const Sheet& /*sheet*/, StateReader& /*in*/) {}
};

/// The loop that all methods of the topic share: frames of `substeps` steps (more where handles are
/// fast: `substeps_of_frame`), remeshing, recording, a checkpoint a frame.
///
/// Each frame has the part "surface" (triangles; point arrays "pattern" [m] (2), "velocity" [m/s]
/// (3); cell arrays "plastic_curvature" [1/m] (3), "damage" [1]), the part "handles" (points held;
/// arrays "handle" [1], "force" [N] (3)), and the diagnostics triangles, vertices, substeps,
/// newton_iterations, halvings, factor_nonzeros, handle_work (J, since the start). Each point of
/// "handles" has an equal share of its handle's mean force over the frame. Scenes with obstacles
/// have the part "obstacles" (triangles, to look at). Phases: "elastic", "connectivity" (the
/// stepper's new analysis after a remeshing) and what the mesher marks. Frame times are multiples
/// of the interval, never sums.
class SheetProcess final : public Process {
 public:
  SheetProcess(const Sheet& sheet, const StepperOptions& options,
               std::unique_ptr<SheetMesher> mesher);
  void run(FrameSink& sink, RunContext& context, const std::optional<State>& resume_from) override;

 private:
  Sheet sheet_;
  StepperOptions options_;
  std::unique_ptr<SheetMesher> mesher_;
};

}  // namespace geoprior::paper
