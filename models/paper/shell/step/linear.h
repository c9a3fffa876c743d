#pragma once

#include <Eigen/Core>

#include "models/paper/shell/step/parts.h"
#include "models/paper/shell/system.h"

namespace geoprior::paper {

/// A step of one linear solve:
///
///   (M + dt (dt + c) K + ...) (v1 - v0) = dt f - dt (dt + c) K v0 + ...
class LinearStep {
 public:
  explicit LinearStep(StepParts& parts) : parts_(parts) {}

  /// @param change    v1 - v0, in solver order (m/s)
  /// @param reaction  of held vertices (N)
  /// @return  false where the system is not positive definite or its solution not finite
  [[nodiscard]] bool solve(Eigen::VectorXd& change, Eigen::VectorXd& reaction);

 private:
  void assemble();
  [[nodiscard]] bool solve_held(Eigen::VectorXd& solution);

  StepParts& parts_;
  // Kept between steps so that they are not allocated again.
  ShellSystem::Sums sums_;
  Eigen::VectorXd right_, scratch_;
};

}  // namespace geoprior::paper
