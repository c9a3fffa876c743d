#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "models/paper/contact/contact.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/step/matrix.h"
#include "models/paper/shell/step/problem.h"
#include "models/paper/shell/stepper_options.h"

namespace geoprior::paper {

/// Contact of a sheet with obstacles during a step (energy and force: ContactPoint).
class StepContact {
 public:
  StepContact(const Sheet& sheet, const StepperOptions& options, const ShellMesh& mesh);

  /// Finds what the sheet touches at the start of a step or would touch by its end.
  void find(const StepProblem& problem, const Eigen::Vector3d& gravity);
  [[nodiscard]] const std::vector<ContactPoint>& found() const { return found_; }
  /// Displacement in the step without contact and elasticity (n x 3, m), where there is anything to
  /// touch.
  [[nodiscard]] const Eigen::MatrixX3d& ballistic() const { return ballistic_; }

  /// What was found, as linear springs that end at the contact distance.
  void add_linear(const StepProblem& problem, StepMatrix& matrix, Eigen::VectorXd& impulse) const;

  /// Of the sheet at x, obstacles being where they are at `time` (J).
  [[nodiscard]] double energy(const Eigen::MatrixX3d& x, double time) const;
  /// dt^2 times gradient and Hessian of the energy at the end of the step.
  void add_gradient(const StepProblem& problem, const Eigen::MatrixX3d& x, StepMatrix& matrix,
                    Eigen::VectorXd& gradient) const;

 private:
  [[nodiscard]] std::vector<ContactPoint> touching(const Eigen::MatrixX3d& x, double time) const;

  double distance_;                    ///< at which the push begins (m)
  std::unique_ptr<ContactTerm> term_;  ///< none: nothing to touch
  std::vector<ContactPoint> found_;
  Eigen::MatrixX3d ballistic_;
};

}  // namespace geoprior::paper
