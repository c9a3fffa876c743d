#include "testbed/runner/judgement/timed_claims.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "testbed/runner/judgement/judgement.h"
#include "testbed/runner/judgement/timing_statistics.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {
namespace {

constexpr double kNoMargin = std::numeric_limits<double>::quiet_NaN();

/// Times that are drawn from: one a frame, or the repetitions of a single one.
std::vector<double> samples_of(const ClaimSpec& claim, const VariantRecord& variant) {
  const std::string phase = claim.metric.substr(std::string("timing:").size());
  const auto found = variant.timing.find(phase);
  if (found == variant.timing.end()) return {};
  std::vector<std::vector<double>> frames = found->second;
  if (claim.at_parameter) {
    std::vector<std::vector<double>> one;
    for (std::size_t i = 0; i < std::min(frames.size(), variant.frames.size()); ++i) {
      const bool here = same_parameter(variant.frames[i].parameter, *claim.at_parameter);
      if (here) one.push_back(frames[i]);
    }
    frames = std::move(one);
  }
  std::vector<double> times;
  if (frames.size() == 1) {
    times = frames.front();
  } else {
    for (const std::vector<double>& repetitions : frames) times.push_back(median(repetitions));
  }
  std::erase_if(times, [](double t) { return std::isnan(t); });
  return times;
}

/// How the values of several times become one: repetitions of one frame by their median.
double reduced_times(const ClaimSpec& claim, const std::vector<double>& times, Reduction how) {
  return claim.at_parameter ? median(times) : reduced(times, how);
}

class Drawn {
 public:
  Drawn(const ClaimSpec& claim, std::vector<double> times, Reduction how)
      : claim_(claim), times_(std::move(times)), how_(how), sample_(times_.size()) {}

  [[nodiscard]] std::size_t size() const { return times_.size(); }
  double by(const std::vector<std::uint32_t>& indices) {
    for (std::size_t i = 0; i < sample_.size(); ++i) sample_[i] = times_[indices[i]];
    return reduced_times(claim_, sample_, how_);
  }

 private:
  const ClaimSpec& claim_;
  std::vector<double> times_;
  Reduction how_;
  std::vector<double> sample_;
};

std::vector<std::uint32_t> drawn_indices(std::size_t count, RandomStream& random) {
  std::vector<std::uint32_t> indices(count);
  for (std::uint32_t& index : indices) index = random.below(static_cast<std::uint32_t>(count));
  return indices;
}

}  // namespace

Interval timed_margin(const ClaimSpec& claim, const CaseRecord& in, std::uint64_t seed) {
  const double margin = judge(claim, in, claim.variant).worst().margin;
  const VariantRecord* of = claim.of ? find_variant(in, *claim.of) : nullptr;
  if (claim.reduce == Reduction::every) return {margin, kNoMargin, kNoMargin};
  Drawn left(claim, samples_of(claim, *find_variant(in, claim.variant)), claim.reduce);
  Drawn right(claim, of != nullptr ? samples_of(claim, *of) : std::vector<double>(),
              claim.of_reduce.value_or(claim.reduce));
  if (left.size() < 2 || (of != nullptr && right.size() < 2)) return {margin, kNoMargin, kNoMargin};
  RandomStream random(seed, "claim " + claim.text);
  std::vector<double> margins(kResamples);
  for (double& drawn : margins) {
    std::vector<std::uint32_t> indices = drawn_indices(left.size(), random);
    const double value = left.by(indices);
    double other = claim.value.value_or(0);
    if (of != nullptr) {
      if (right.size() != left.size()) indices = drawn_indices(right.size(), random);
      other = right.by(indices);
    }
    drawn = margin_of(claim, value, claim.factor * other + claim.offset);
  }
  return {margin, quantile(margins, 0.025), quantile(margins, 0.975)};
}

Interval timed_margin(const ClaimSpec& claim, const StudyRecord& study) {
  const auto margin = [&](double value) {
    return margin_of(claim, value, claim.factor * claim.value.value_or(0) + claim.offset);
  };
  const double low = margin(study.low), high = margin(study.high);
  return {margin(study.value), std::min(low, high), std::max(low, high)};
}

bool is_decided(const Interval& margin) { return margin.low > 0 || margin.high < 0; }

}  // namespace geoprior
