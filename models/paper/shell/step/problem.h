#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/sheet/handle_map.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/step/matrix.h"

namespace geoprior::paper {

/// What is fixed during a step of a sheet; vectors in solver order.
struct StepProblem {
  const ShellState* state = nullptr;
  double dt = 0, time = 0;                        ///< its length and end (s)
  Eigen::VectorXd velocity;                       ///< v0
  Eigen::VectorXd loads;                          ///< weight and dead loads (N)
  std::vector<HandleMap::Target> targets;         ///< prescribed
  std::vector<HandleMap::Target> springs;         ///< of hands that give
  std::vector<HandleMap::Target> springs_before;  ///< all targets at the start of the step
  std::vector<char> held;                         ///< of each position
  Eigen::VectorXd prescribed;                     ///< v1 - v0 of held vertices, 0 of others

  /// Takes up the step of `length` (s) that begins in a state.
  /// @param mass  of each vertex (kg)
  void pose(const Sheet& sheet, const HandleMap& handles, const Eigen::VectorXd& mass,
            const StepMatrix& rows, const ShellState& start, double length);
  /// The sheet where it was, its handles moved.
  [[nodiscard]] Eigen::MatrixX3d held_still() const;
};

}  // namespace geoprior::paper
