#include "metrics/shape/second_differences.h"

#include <cstddef>

#include "metrics/tracks/of_values.h"

namespace geoprior {

void SecondDifferences::add(const Eigen::MatrixX3d& x) {
  const std::size_t i = frames_++;
  x_[i % 3] = x;
  if (i < 2) return;
  const Eigen::VectorXd difference =
      (x_[i % 3] - 2 * x_[(i + 2) % 3] + x_[(i + 1) % 3]).rowwise().norm();
  differences_.insert(differences_.end(), difference.begin(), difference.end());
}

std::optional<double> SecondDifferences::quantile(int percent) const {
  return percentile_of(differences_, percent);
}

}  // namespace geoprior
