#pragma once

#include <Eigen/Core>

namespace geoprior::skinning {

/// Hermite radial basis function: a smooth signed distance through given points with given normals.
///
///   d(p) = sum_k alpha_k phi(|p - p_k|) + beta_k . grad phi(|p - p_k|),   phi(x) = x^3   (eq. 3.1)
///
/// alpha_k and beta_k solve d(p_k) = 0, grad d(p_k) = n_k: a dense, indefinite system of 4 N
/// unknowns, factorised once (LU with partial pivoting). The fit works in coordinates scaled by
/// `scale` because x^3 in metres is badly conditioned; values come out in units of `scale`, so
/// that `value` is s = d / r when `scale` is the support radius r. Away from the samples |grad d|
/// is not 1: this is no exact distance.
/// Source: Macêdo, Gois, Velho 2011; thesis eq. 3.1.
class Hrbf {
 public:
  struct Value {
    double value = 0;                                    ///< d / scale, negative inside
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of d: no unit, near 1 in length
  };

  Hrbf() = default;
  /// @param points   N x 3, metres, pairwise distinct
  /// @param normals  N x 3, unit, outward
  /// @param scale    metres, > 0
  /// @throws Error   on coinciding points, different sizes or a system that cannot be solved
  Hrbf(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& normals, double scale);

  [[nodiscard]] Value operator()(const Eigen::Vector3d& p) const;
  /// Values at the rows of `points` (n x 4: gradient, then value), vectorised over points.
  void evaluate(const Eigen::MatrixX3d& points, Eigen::MatrixX4d& gradient_and_value) const;

  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] int centre_count() const { return static_cast<int>(centres_.rows()); }

 private:
  Eigen::MatrixX3d centres_;       // scaled
  Eigen::MatrixX4d coefficients_;  // alpha, beta
  double scale_ = 1;
};

}  // namespace geoprior::skinning
