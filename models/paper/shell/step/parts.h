#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "models/paper/sheet/handle_map.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/elements.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/step/contact.h"
#include "models/paper/shell/step/friction.h"
#include "models/paper/shell/step/matrix.h"
#include "models/paper/shell/step/problem.h"
#include "models/paper/shell/stepper_options.h"

namespace geoprior::paper {

/// A sheet on one connectivity as its steps see it: what is computed once, and the step at hand.
struct StepParts {
  /// @throws Error  as ShellDynamics
  StepParts(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
            const ShellState& state);

  /// Takes up the step of `dt` (s) that begins in a state.
  void pose(const ShellState& state, double dt);
  [[nodiscard]] int vertices() const { return static_cast<int>(mass.size()); }

  const Sheet& sheet;
  const StepperOptions& options;
  ShellElements elements;
  HandleMap handles;
  Eigen::VectorXd mass;  ///< of each vertex (kg)
  StepContact contact;
  StepFriction friction;
  StepMatrix matrix;
  StepProblem problem;
};

}  // namespace geoprior::paper
