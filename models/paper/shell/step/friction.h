#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/contact/contact.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/step/contact.h"
#include "models/paper/shell/step/matrix.h"
#include "models/paper/shell/step/problem.h"
#include "models/paper/shell/stepper_options.h"

namespace geoprior::paper {

/// Friction where a sheet presses on obstacles during a step (law: FrictionPoint). The normal force
/// is that of the start of the step.
class StepFriction {
 public:
  StepFriction(const Sheet& sheet, const StepperOptions& options);

  /// Takes up the contacts that push at the start of a step.
  void find(const StepProblem& problem, const StepContact& contact);

  /// A viscous force with the coefficient that the expected slip has.
  void add_linear(const StepProblem& problem, StepMatrix& matrix, Eigen::VectorXd& impulse) const;

  /// Adds limit times the smoothed distance slid by the sheet at x (J), point by point: the order
  /// of the sum is part of the result.
  void add_energy(const StepProblem& problem, const Eigen::MatrixX3d& x, double& energy) const;
  /// dt^2 times gradient and Hessian of the energy.
  void add_gradient(const StepProblem& problem, const Eigen::MatrixX3d& x, StepMatrix& matrix,
                    Eigen::VectorXd& gradient) const;

 private:
  [[nodiscard]] double expected_slip(const StepProblem& problem, const Eigen::MatrixX3d& ballistic,
                                     const ContactPoint& point, double limit) const;

  double coefficient_;        ///< mu
  double area_density_;       ///< of the sheet (kg/m^2)
  double contact_distance_;   ///< m
  double contact_stiffness_;  ///< N/m^3
  double creep_speed_;        ///< s_0 (m/s)
  std::vector<FrictionPoint> points_;
};

}  // namespace geoprior::paper
