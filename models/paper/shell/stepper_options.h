#pragma once

#include "core/options.h"
#include "models/paper/shell/bending_law.h"

namespace geoprior::paper {

enum class Integration { linear, newton };  ///< one linear solve a step, or implicit Euler solved
/// Sparse factorisations. They differ by round-off alone, so that a file does not choose:
/// `supernodal`, ours, was fastest at every size measured (200 to 4,096 triangles); the others are
/// what it is tested and timed against.
enum class LinearSolver { eigen, cholmod, supernodal };

/// How a sheet is stepped in time; the same for every mesh, so that meshes are compared and nothing
/// else.
struct StepperOptions {
  Integration integration = Integration::linear;
  BendingLaw bending;
  bool plasticity = true;
  int newton_iterations = 100;
  double newton_tolerance = 1e-8;
  LinearSolver solver = LinearSolver::supernodal;
  double contact_distance = 5e-4;  ///< m
  double contact_stiffness = 1e9;  ///< N/m^3
  double contact_spacing = 0.01;   ///< m
  double creep_speed = 1e-3;       ///< m/s
};
void describe(OptionVisitor& v, StepperOptions& options);

}  // namespace geoprior::paper
