#include "models/sketch/flatten/anderson_mixing.h"

#include <Eigen/Cholesky>

namespace geoprior::sketch {
namespace {

/// Added to the diagonal of the least squares, relative to it: changes become nearly parallel.
constexpr double kMixingRidge = 1e-12;

}  // namespace

void AndersonMixing::remember(const Eigen::VectorXd& residual, const Eigen::VectorXd& image) {
  if (std::ssize(residual_change_) < window_) {
    residual_change_.resize(window_);
    image_change_.resize(window_);
    gram_.setZero(window_, window_);
  }
  if (used_ == 0) place_ = 0;
  residual_change_[place_] = residual - last_residual_;
  image_change_[place_] = image - last_image_;
  if (used_ < window_) ++used_;
  for (int i = 0; i < used_; ++i)
    gram_(i, place_) = gram_(place_, i) = residual_change_[i].dot(residual_change_[place_]);
  place_ = (place_ + 1) % window_;
}

Eigen::VectorXd AndersonMixing::next(const Eigen::VectorXd& x, const Eigen::VectorXd& image) {
  if (window_ == 0) return image;
  const Eigen::VectorXd residual = image - x;
  if (has_last_) remember(residual, image);
  last_residual_ = residual;
  last_image_ = image;
  has_last_ = true;
  if (used_ == 0) return image;
  Eigen::MatrixXd gram = gram_.topLeftCorner(used_, used_);
  gram.diagonal() *= 1 + kMixingRidge;
  Eigen::VectorXd right(used_);
  for (int i = 0; i < used_; ++i) right(i) = residual_change_[i].dot(residual);
  const Eigen::VectorXd weights = gram.ldlt().solve(right);
  Eigen::VectorXd mixed = image;
  if (!weights.allFinite()) return mixed;
  for (int i = 0; i < used_; ++i) mixed -= weights(i) * image_change_[i];
  return mixed;
}

}  // namespace geoprior::sketch
