#pragma once

#include <Eigen/Core>

#include "models/paper/cholesky/block_matrix.h"
#include "models/paper/shell/step/parts.h"
#include "models/paper/shell/system.h"

namespace geoprior::paper {

/// What implicit Euler minimises over x, held vertices at their places:
///
///   1/2 |x - x0 - dt v0 - dt^2 M^-1 loads|^2_M + dt^2 (E + contact + friction + springs)
///     + dt c/2 |x - x0|^2_K
class StepPotential {
 public:
  explicit StepPotential(StepParts& parts) : parts_(parts) {}

  /// Takes up the step at hand.
  void prepare();
  [[nodiscard]] double value(const Eigen::MatrixX3d& x);
  /// Gradient in solver order, and the Hessian, projected to positive semidefinite, in the matrix.
  /// @return  the largest norm of its terms
  double gradient(const Eigen::MatrixX3d& x, Eigen::VectorXd& gradient);

 private:
  StepParts& parts_;
  Eigen::VectorXd start_, inertial_;  ///< x0; x0 + dt v0 + dt^2 M^-1 loads
  BlockMatrix damping_;               ///< dt c K
  // Kept between steps so that they are not allocated again.
  ShellSystem::Sums sums_;
  Eigen::VectorXd moved_, scratch_;
};

}  // namespace geoprior::paper
