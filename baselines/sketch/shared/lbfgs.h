#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>

namespace geoprior::sketch {

/// Solves with a matrix H0 near the Hessian, in place: values (n x 3) become H0^-1 values.
using Preconditioner = std::function<void(Eigen::MatrixX3d&)>;

/// The inverse Hessian of a function of positions as far as the last steps told it (L-BFGS; Liu and
/// Nocedal 1989), built upon a given H0 that is scaled by what the last step told.
class Lbfgs {
 public:
  /// @param memory  steps that are kept; 0: H0 alone
  explicit Lbfgs(int memory) : memory_(memory) {}

  /// Takes in a step and the change of the gradient over it. One along which the slope did not
  /// rise tells nothing of a positive definite Hessian and is left out.
  void add(const Eigen::MatrixX3d& step, const Eigen::MatrixX3d& change,
           const Preconditioner& precondition);

  /// Minus the inverse Hessian times the gradient: a direction of descent.
  [[nodiscard]] Eigen::MatrixX3d direction(const Eigen::MatrixX3d& gradient,
                                           const Preconditioner& precondition) const;

  void forget();

 private:
  struct Pair {
    Eigen::MatrixX3d step;
    Eigen::MatrixX3d change;
    double inverse_product;  ///< 1 / (step . change)
  };

  int memory_;
  std::deque<Pair> pairs_;  ///< oldest first
  double scale_ = 1;        ///< of H0^-1
};

}  // namespace geoprior::sketch
