#include "metrics/weighted_quantile.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"

namespace geoprior {

double weighted_quantile(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                         double share) {
  if (values.size() == 0 || values.size() != weights.size()) {
    throw Error(std::to_string(values.size()) + " values and " + std::to_string(weights.size()) +
                    " weights",
                "weighted quantile", "equal numbers, at least one");
  }
  std::vector<Eigen::Index> order(values.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return values(a) < values(b); });
  const double wanted = share * weights.sum();
  double passed = 0;
  for (const Eigen::Index i : order) {
    passed += weights(i);
    if (passed >= wanted) return values(i);
  }
  return values(order.back());
}

}  // namespace geoprior
