#include "models/paper/shell/secant_pairs.h"

#include <vector>

namespace geoprior::paper {

bool SecantPairs::apply(Eigen::VectorXd& gradient,
                        const std::function<bool(Eigen::VectorXd&)>& solve) const {
  std::vector<double> part(pairs_.size());
  for (std::size_t i = pairs_.size(); i-- > 0;) {
    part[i] = pairs_[i].inverse * pairs_[i].step.dot(gradient);
    gradient -= part[i] * pairs_[i].change;
  }
  if (!solve(gradient)) return false;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const double back = pairs_[i].inverse * pairs_[i].change.dot(gradient);
    gradient += (part[i] - back) * pairs_[i].step;
  }
  return true;
}

void SecantPairs::remember(const Eigen::VectorXd& step, const Eigen::VectorXd& gradient_change) {
  constexpr std::size_t kMost = 8;
  constexpr double kLeastCurvature = 1e-12;
  const double product = step.dot(gradient_change);
  if (!(product > kLeastCurvature * step.norm() * gradient_change.norm())) return;
  if (pairs_.size() == kMost) pairs_.pop_front();
  pairs_.push_back({step, gradient_change, 1 / product});
}

}  // namespace geoprior::paper
