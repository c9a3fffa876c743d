#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::paper {

/// What one step did. Positions and velocities are only meaningful when it is `good`: solved,
/// finite, no triangle collapsed or turned over.
struct StepResult {
  bool good = false;
  bool overshot = false;  ///< linear: stretching alone takes more energy than there was
  int solves = 0;
  double residual = 0;
  Eigen::MatrixX3d x, v;
  double handle_work = 0;                     ///< by prescribed handles (J)
  std::vector<Eigen::Vector3d> handle_force;  ///< N, on the sheet
};

}  // namespace geoprior::paper
