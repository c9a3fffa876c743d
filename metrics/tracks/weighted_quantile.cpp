#include "metrics/tracks/weighted_quantile.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"

namespace geoprior {

std::vector<double> weighted_quantiles(const Eigen::VectorXd& values,
                                       const Eigen::VectorXd& weights,
                                       std::span<const double> shares) {
  if (values.size() == 0 || values.size() != weights.size()) {
    throw Error(std::to_string(values.size()) + " values and " + std::to_string(weights.size()) +
                    " weights",
                "weighted quantile", "equal numbers, at least one");
  }
  std::vector<Eigen::Index> order(values.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return values(a) < values(b); });
  const double whole = weights.sum();
  std::vector<double> quantiles;
  double passed = 0;
  for (const Eigen::Index i : order) {
    passed += weights(i);
    while (quantiles.size() < shares.size() && passed >= shares[quantiles.size()] * whole)
      quantiles.push_back(values(i));
  }
  quantiles.resize(shares.size(), values(order.back()));
  return quantiles;
}

double weighted_quantile(const Eigen::VectorXd& values, const Eigen::VectorXd& weights,
                         double share) {
  return weighted_quantiles(values, weights, {&share, 1}).front();
}

}  // namespace geoprior
