#include "baselines/sketch/shared/lbfgs.h"

#include <vector>

namespace geoprior::sketch {
namespace {

/// Least cosine between a step and the change of the gradient over it.
constexpr double kLeastCosine = 1e-8;

double inner_product(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

void Lbfgs::add(const Eigen::MatrixX3d& step, const Eigen::MatrixX3d& change,
                const Preconditioner& precondition) {
  const double product = inner_product(step, change);
  if (memory_ == 0 || !(product > kLeastCosine * step.norm() * change.norm())) return;
  Eigen::MatrixX3d smooth = change;
  precondition(smooth);
  scale_ = product / inner_product(change, smooth);
  if (std::ssize(pairs_) == memory_) pairs_.pop_front();
  pairs_.push_back({step, change, 1 / product});
}

Eigen::MatrixX3d Lbfgs::direction(const Eigen::MatrixX3d& gradient,
                                  const Preconditioner& precondition) const {
  Eigen::MatrixX3d q = -gradient;
  std::vector<double> along(pairs_.size());
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    along[i] = pairs_[i].inverse_product * inner_product(pairs_[i].step, q);
    q -= along[i] * pairs_[i].change;
  }
  precondition(q);
  q *= scale_;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const double back = pairs_[i].inverse_product * inner_product(pairs_[i].change, q);
    q += (along[i] - back) * pairs_[i].step;
  }
  return q;
}

void Lbfgs::forget() {
  pairs_.clear();
  scale_ = 1;
}

}  // namespace geoprior::sketch
