#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "models/paper/sheet/handle_map.h"
#include "models/paper/shell/elements.h"
#include "models/paper/shell/energies.h"
#include "models/paper/shell/lumped_mass.h"
#include "models/paper/shell/step/linear.h"
#include "models/paper/shell/step/parts.h"
#include "models/paper/shell/step/potential.h"
#include "models/paper/shell/step/result.h"
#include "models/paper/shell/stepper_options.h"

namespace geoprior::paper {

/// A sheet on one connectivity: all that is computed once for it, and one implicit Euler step,
///
///   M (v1 - v0) / dt = -dE/dx (x1) - c K v1 + contact + loads + M g,      x1 = x0 + dt v1
///
/// M lumped, E elastic, c the damping time, K the Hessian of E at x0 projected to positive
/// semidefinite. `linear` replaces dE/dx (x1) by dE/dx (x0) + dt K v1, so that a step is one linear
/// solve (step/linear.h); `newton` solves the equation (step/newton.h). Vertices held by a handle
/// have v1 given; their rows are taken out of the system and yield the handle's reaction. A hand
/// that gives is a spring k (y - x1) to the place y that it wants, implicit in both.
class ShellDynamics {
 public:
  /// The sheet and the options are those of the caller and must stay.
  /// @throws Error  on a triangle without area or turned over in the pattern, on a vertex that no
  ///                triangle uses, on a handle without vertices
  ShellDynamics(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                const ShellState& state);
  ShellDynamics(const ShellDynamics&) = delete;
  ShellDynamics& operator=(const ShellDynamics&) = delete;

  void step(const ShellState& state, double dt, Integration integration, StepResult& result);

  [[nodiscard]] ShellEnergies energies(const ShellState& state) const;
  [[nodiscard]] Eigen::MatrixX3d elastic_forces(const ShellState& state) const;
  [[nodiscard]] Eigen::MatrixX3d elastic_forces(const ShellState& state,
                                                const std::vector<int>& triangles) const;
  [[nodiscard]] long factor_nonzeros() const { return parts_.matrix.factor_nonzeros(); }
  [[nodiscard]] const HandleMap& handles() const { return parts_.handles; }
  [[nodiscard]] const ShellElements& elements() const { return parts_.elements; }
  [[nodiscard]] int vertices() const { return parts_.vertices(); }
  [[nodiscard]] int triangles() const { return parts_.elements.size(); }

 private:
  void place(const Eigen::VectorXd& change, StepResult& result) const;
  [[nodiscard]] bool overshoots(const Eigen::MatrixX3d& x);

  StepParts parts_;
  LinearStep linear_{parts_};
  StepPotential potential_{parts_};
};

}  // namespace geoprior::paper
