// Implicit Euler solved: the minimum over x of
//   1/2 |x - x0 - dt v0 - dt^2 M^-1 loads|^2_M + dt^2 (E + contact + friction) + dt c/2 |x -
//   x0|^2_K
#include <cmath>

#include "baselines/paper/shell_dynamics.h"

namespace geoprior {

bool ShellDynamics::solve_newton(Step& /*result*/, Eigen::VectorXd& /*reaction*/) { return false; }

}  // namespace geoprior
