#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>

namespace geoprior::paper {

/// The last steps of a minimisation and what they changed in the gradient: they correct a Hessian
/// that is known only in part (L-BFGS; Liu, Nocedal 1989). A Hessian projected to positive
/// semidefinite is too stiff where the sheet buckles; by itself it makes Newton's method linear.
class SecantPairs {
 public:
  /// Overwrites the gradient by the inverse Hessian times it; `solve` applies the known inverse.
  /// @return  what `solve` returned
  bool apply(Eigen::VectorXd& gradient, const std::function<bool(Eigen::VectorXd&)>& solve) const;
  /// Remembers a step unless the gradient says that the function is not convex along it.
  void remember(const Eigen::VectorXd& step, const Eigen::VectorXd& gradient_change);
  void clear() { pairs_.clear(); }

 private:
  struct Pair {
    Eigen::VectorXd step, change;
    double inverse;  ///< 1 / (step . change)
  };
  std::deque<Pair> pairs_;  ///< oldest first
};

}  // namespace geoprior::paper
