#include "metrics/shape/second_differences.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace geoprior {

void SecondDifferences::add(const Eigen::MatrixX3d& x) {
  const std::size_t i = frames_++;
  x_[i % 3] = x;
  if (i < 2) return;
  const Eigen::VectorXd difference =
      (x_[i % 3] - 2 * x_[(i + 2) % 3] + x_[(i + 1) % 3]).rowwise().norm();
  differences_.insert(differences_.end(), difference.begin(), difference.end());
}

double SecondDifferences::quantile(int percent) const {
  assert(!differences_.empty() && 0 <= percent && percent < 100);
  std::vector<double> sorted = differences_;
  const auto at = sorted.begin() + (sorted.size() * percent / 100);
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace geoprior
