#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::sketch {

/// Anderson acceleration of a fixed-point iteration x <- G(x): the next x is the combination of the
/// last images G(x_i) whose residuals G(x_i) - x_i, combined alike, are least.
///
/// It may overshoot: the caller keeps the plain image when the energy grows, and calls `restart`.
/// Source: Anderson 1965; Walker and Ni 2011; Peng, Deng, Zhang, Geng, Qin, Liu, Anderson
/// Acceleration for Geometry Optimization and Physics Simulation, 2018.
class AndersonMixing {
 public:
  /// @param window  images that are combined beside the last one; 0: none
  explicit AndersonMixing(int window) : window_(window) {}

  /// @param x      where the iteration is
  /// @param image  G(x)
  /// @return       the next x
  Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& image);
  void restart() {
    used_ = 0;
    has_last_ = false;
  }

 private:
  void remember(const Eigen::VectorXd& residual, const Eigen::VectorXd& image);

  int window_;
  int used_ = 0;   ///< differences kept
  int place_ = 0;  ///< of the next one
  bool has_last_ = false;
  Eigen::VectorXd last_residual_, last_image_;
  std::vector<Eigen::VectorXd> residual_change_, image_change_;
  Eigen::MatrixXd gram_;  ///< of the changes of residuals
};

}  // namespace geoprior::sketch
