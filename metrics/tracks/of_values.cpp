#include "metrics/tracks/of_values.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace geoprior {

std::optional<double> percentile_of(std::vector<double> values, int percent) {
  assert(0 <= percent && percent < 100);
  if (values.empty()) return std::nullopt;
  const auto at = values.begin() + (values.size() * percent / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::optional<double> largest_of(const Eigen::Ref<const Eigen::VectorXd>& values) {
  if (values.size() == 0) return std::nullopt;
  return values.maxCoeff();
}

}  // namespace geoprior
