#include "solvers/fluid/features/segmentation_thresholds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace geoprior::fluid {
namespace {

constexpr double kCalm = 0.06;  // 90th percentile of s; splashes and wakes lie above 0.043

float quantile(std::vector<float>& values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[k];
}

double noise_level(std::vector<float> s, double factor) {
  const float median = quantile(s, 0.5);
  for (float& value : s) value = std::abs(value - median);
  return static_cast<double>(median) + factor * static_cast<double>(quantile(s, 0.5));
}

/// The threshold that splits a histogram of ln s into the two classes of largest variance between
/// (Otsu 1979).
double otsu_of_logarithm(const std::vector<float>& s) {
  constexpr int kBins = 128;
  const double low = std::log(1e-4), high = std::log(2.0);
  std::array<double, kBins> count{};
  for (const float value : s) {
    const double at = (std::log(std::max<double>(value, 1e-4)) - low) / (high - low) * kBins;
    count[std::clamp(static_cast<int>(at), 0, kBins - 1)] += 1;
  }
  double total = 0;
  for (int i = 0; i < kBins; ++i) total += i * count[i];
  double below = 0, sum_below = 0, best = -1;
  int split = kBins / 2;
  for (int i = 0; i + 1 < kBins; ++i) {
    below += count[i];
    sum_below += i * count[i];
    const double above = static_cast<double>(s.size()) - below;
    if (below == 0 || above == 0) continue;
    const double gap = sum_below / below - (total - sum_below) / above;
    if (below * above * gap * gap > best) {
      best = below * above * gap * gap;
      split = i + 1;
    }
  }
  return std::exp(low + (high - low) * split / kBins);
}

std::string number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", x);
  return text.data();
}

}  // namespace

Thresholds automatic_thresholds(std::span<const std::vector<float>> frames, double floor,
                                const SegmentationOptions& options,
                                std::vector<std::string>& warnings) {
  std::vector<double> restlessness;
  for (const std::vector<float>& s : frames) {
    std::vector<float> copy = s;
    restlessness.push_back(s.empty() ? 1e30 : static_cast<double>(quantile(copy, 0.9)));
  }
  std::vector<float> pooled;
  if (restlessness.empty()) return {options.seed_factor * floor, floor};
  const double calmest = *std::min_element(restlessness.begin(), restlessness.end());
  const bool calm = calmest <= kCalm;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (calm && restlessness[f] > std::max(2 * calmest, floor)) continue;
    pooled.insert(pooled.end(), frames[f].begin(), frames[f].end());
  }
  if (pooled.empty()) return {options.seed_factor * floor, floor};
  Thresholds result;
  if (calm) {
    result.low = std::max(noise_level(std::move(pooled), options.noise_factor), floor);
    result.high = options.seed_factor * result.low;
    return result;
  }
  result.high = std::max(otsu_of_logarithm(pooled), options.seed_factor * floor);
  result.low = result.high / options.seed_factor;
  warnings.push_back("no frame is calm (90th percentile of |H| h at least " + number(calmest) +
                     "): thresholds " + number(result.high) + " and " + number(result.low) +
                     " separate two classes of curvature; give your own if they do not fit");
  return result;
}

}  // namespace geoprior::fluid
