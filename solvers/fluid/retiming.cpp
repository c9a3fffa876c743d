#include <algorithm>
#include <cmath>

#include "solvers/fluid/edits.h"

namespace geoprior {
namespace {

double slope_after(const std::vector<TimeKey>& keys, std::size_t i) {
  return (keys[i + 1].source - keys[i].source) / (keys[i + 1].target - keys[i].target);
}

/// Slope of the cubic at a key: the mean of the slopes beside it weighted by time, limited to three
/// times the smaller one, which keeps a cubic monotone (Fritsch and Carlson 1980).
double slope_at(const std::vector<TimeKey>& keys, std::size_t i) {
  if (keys.size() < 2) return 1;
  if (i == 0) return slope_after(keys, 0);
  if (i + 1 == keys.size()) return slope_after(keys, i - 1);
  const double before = slope_after(keys, i - 1), after = slope_after(keys, i);
  if (before * after <= 0) return 0;
  const double dt_before = keys[i].target - keys[i - 1].target;
  const double dt_after = keys[i + 1].target - keys[i].target;
  const double mean = (before * dt_before + after * dt_after) / (dt_before + dt_after);
  const double limit = 3 * std::min(std::abs(before), std::abs(after));
  return std::clamp(mean, -limit, limit);
}

}  // namespace

double retimed(const std::vector<TimeKey>& keys, double target_time) {
  if (keys.empty()) return target_time;
  const std::size_t last = keys.size() - 1;
  if (target_time <= keys[0].target) {
    return keys[0].source + slope_at(keys, 0) * (target_time - keys[0].target);
  }
  if (target_time >= keys[last].target) {
    return keys[last].source + slope_at(keys, last) * (target_time - keys[last].target);
  }
  std::size_t i = 0;
  while (keys[i + 1].target <= target_time) ++i;
  const double dt = keys[i + 1].target - keys[i].target;
  const double s = (target_time - keys[i].target) / dt, s2 = s * s, s3 = s2 * s;
  return keys[i].source + (3 * s2 - 2 * s3) * (keys[i + 1].source - keys[i].source) +
         dt * ((s3 - 2 * s2 + s) * slope_at(keys, i) + (s3 - s2) * slope_at(keys, i + 1));
}

}  // namespace geoprior
