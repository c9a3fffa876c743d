#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/context.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/energies.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper_options.h"

namespace geoprior::paper {

/// What one step took.
struct StepReport {
  int newton_iterations = 0;  ///< linear solves
  int halvings = 0;
  double residual = 0;     ///< reached, relative (newton)
  double handle_work = 0;  ///< done by prescribed handles, with their own motion (J)
  std::vector<Eigen::Vector3d>
      handle_force;  ///< on the sheet by each handle, mean over the step (N)
};

/// Implicit time stepping of one sheet (equations: dynamics.h): elastic shell, handles, dead
/// loads, contact with obstacles, then plastic flow. Keeps the analysis of the connectivity
/// (masses, element fits, sparsity, offsets, symbolic factorisation) until the connectivity
/// changes.
///
/// What it does not do: the sheet passes through itself. Friction takes the normal force of the
/// start of the step; with `linear` a sheet that slides over a curved obstacle feels it unevenly.
/// Damping is that of the stiffness at the start of a step, so that it also slows rotations.
/// `linear` is exact in the forces only to first order in dt; `newton` reports what is left.
class ShellStepper {
 public:
  ShellStepper(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed);
  ~ShellStepper();
  ShellStepper(ShellStepper&&) noexcept;
  ShellStepper& operator=(ShellStepper&&) noexcept;

  /// Takes up a connectivity: must be called before the first step and after every remeshing.
  /// @throws Error  on a triangle without area or turned over in the pattern (names it)
  void set_mesh(const ShellState& state);

  /// Advances by `dt` (s); halves the step when it does not converge (NaN, residual, inverted
  /// pattern map) or, linear, stretches the sheet with energy from nowhere, up to eight times,
  /// then throws Error naming the time.
  StepReport step(ShellState& state, double dt, RunContext& context);

  /// The sheet gives way: an implicit step of `dt` from rest, with the handles where they are now
  /// and without plastic flow, moves it; its time and velocities stay. A linear step may overshoot:
  /// compare the energies.
  /// @throws Error  when the step does not converge; the state is what it was
  void relax(ShellState& state, double dt);

  [[nodiscard]] ShellEnergies energies(const ShellState& state) const;
  /// Elastic force on every vertex (n x 3, N): -dE/dx of membrane and bending.
  [[nodiscard]] Eigen::MatrixX3d elastic_forces(const ShellState& state) const;
  /// What these triangles contribute to it.
  [[nodiscard]] Eigen::MatrixX3d elastic_forces(const ShellState& state,
                                                const std::vector<int>& triangles) const;
  /// Shape operators S_uu, S_uv, S_vv of all triangles (m x 3, 1/m), those of the bending energy.
  [[nodiscard]] Eigen::MatrixX3d shape_operators(const ShellState& state) const;
  [[nodiscard]] long factor_nonzeros() const;
  /// Vertices that an active handle prescribes at `time`, and by which handle.
  struct Held {
    int vertex;
    int handle;
  };
  [[nodiscard]] std::vector<Held> held(double time) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior::paper
