#include "metrics/arrangement/distributions.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace geoprior {

std::optional<double> kolmogorov_smirnov(std::span<const double> first,
                                         std::span<const double> second) {
  if (first.empty() || second.empty()) return std::nullopt;
  std::vector<double> a(first.begin(), first.end()), b(second.begin(), second.end());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double out = 0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    // Both shares step at the next value, over all that are equal to it.
    const double x = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= x) ++i;
    while (j < b.size() && b[j] <= x) ++j;
    const double difference = static_cast<double>(i) / static_cast<double>(a.size()) -
                              static_cast<double>(j) / static_cast<double>(b.size());
    out = std::max(out, std::abs(difference));
  }
  return out;
}

}  // namespace geoprior
