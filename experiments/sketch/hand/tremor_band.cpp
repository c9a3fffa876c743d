#include "experiments/sketch/hand/tremor_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr int kMostSamples = 1500, kMostWaves = 500;

/// Points at equal steps of a clock.
/// @param chain  closed: its first point is repeated
/// @param clock  of every point of the chain, from 0, not falling
Eigen::MatrixX2d sampled(const Points& chain, const std::vector<double>& clock, int count,
                         bool closed) {
  Eigen::MatrixX2d samples(count, 2);
  const int steps = closed ? count : count - 1;
  std::size_t k = 0;
  for (int i = 0; i < count; ++i) {
    const double at = clock.back() * i / steps;
    while (k + 2 < clock.size() && clock[k + 1] < at) ++k;
    const double span = clock[k + 1] - clock[k];
    const double t = span > 0 ? std::clamp((at - clock[k]) / span, 0.0, 1.0) : 0;
    samples.row(i) = (chain[k] + t * (chain[k + 1] - chain[k])).transpose();
  }
  return samples;
}

/// Power of k waves along the stroke: mean squares of both coordinates.
std::vector<double> powers(Eigen::MatrixX2d samples, bool closed) {
  const int n = static_cast<int>(samples.rows());
  if (!closed) {
    const Eigen::RowVector2d first = samples.row(0), whole = samples.row(n - 1) - first;
    for (int i = 0; i < n; ++i) samples.row(i) -= first + whole * i / (n - 1);
  }
  std::vector<double> power(std::min(n / 2, kMostWaves + 1), 0);
  for (int k = 1; k < std::ssize(power); ++k) {
    const double step = 2 * std::numbers::pi * k / n;
    const double turn_cosine = std::cos(step), turn_sine = std::sin(step);
    double cosine = 1, sine = 0;
    Eigen::RowVector2d even(0, 0), odd(0, 0);
    for (int i = 0; i < n; ++i) {
      even += cosine * samples.row(i);
      odd += sine * samples.row(i);
      const double next = cosine * turn_cosine - sine * turn_sine;
      sine = sine * turn_cosine + cosine * turn_sine;
      cosine = next;
    }
    power[k] = 2 * (even.squaredNorm() + odd.squaredNorm()) / (static_cast<double>(n) * n);
  }
  return power;
}

/// Waves at which k^3 P(k), averaged over an eighth of k to both sides, is largest.
int peak_of(const std::vector<double>& power) {
  const int count = static_cast<int>(power.size());
  constexpr int kFewest = 4;
  int peak = std::min(kFewest, count - 1);
  double largest = -1;
  for (int k = kFewest; k < count; ++k) {
    const int reach = std::max(2, k / 8);
    const int low = std::max(1, k - reach), high = std::min(count - 1, k + reach);
    double sum = 0;
    for (int j = low; j <= high; ++j) sum += std::pow(j, 3) * power[j];
    if (sum / (high - low + 1) > largest) {
      largest = sum / (high - low + 1);
      peak = k;
    }
  }
  return peak;
}

double between(const std::vector<double>& power, double waves) {
  double low = 0, high = 0;
  for (int k = 1; k < std::ssize(power) && k <= 2 * waves; ++k) {
    if (k > waves / 4 && k < waves / 2) low += power[k];
    if (k >= waves / 2) high += power[k];
  }
  return high > 0 ? low / high : std::numeric_limits<double>::infinity();
}

TremorBand band_of(const std::vector<double>& power) {
  TremorBand band;
  band.waves = peak_of(power);
  for (int pass = 0; pass < 3; ++pass) {
    const int low = std::max(1, static_cast<int>(band.waves / 2)),
              high = std::min(static_cast<int>(power.size()) - 1, static_cast<int>(2 * band.waves));
    double sum = 0, first = 0, second = 0;
    for (int k = low; k <= high; ++k) {
      sum += power[k];
      first += k * power[k];
      second += static_cast<double>(k) * k * power[k];
    }
    if (sum <= 0) break;
    band.waves = first / sum;
    band.spread = std::sqrt(std::max(0.0, second / sum - band.waves * band.waves));
    band.sigma = std::sqrt(sum / 2);
  }
  band.between = between(power, band.waves);
  return band;
}

std::vector<double> steps_clock(const Points& chain) {
  std::vector<double> clock(chain.size());
  for (std::size_t i = 0; i < chain.size(); ++i) clock[i] = static_cast<double>(i);
  return clock;
}

std::vector<double> length_clock(const Points& chain) {
  std::vector<double> clock{0};
  for (std::size_t i = 0; i + 1 < chain.size(); ++i)
    clock.push_back(clock.back() + (chain[i + 1] - chain[i]).norm());
  return clock;
}

/// Clock of points at equal distances: cube roots of the turn over two steps to both sides.
std::vector<double> bends_clock(const Points& chain) {
  constexpr int kReach = 2;
  constexpr double kLeastShare = 0.3;  // of the mean: what straight lines take
  const int n = static_cast<int>(chain.size());
  std::vector<double> slow(n, 0);
  double mean = 0;
  for (int i = 0; i < n; ++i) {
    const int here = std::clamp(i, kReach, n - 1 - kReach);
    slow[i] = std::cbrt(std::abs(
        signed_angle(chain[here] - chain[here - kReach], chain[here + kReach] - chain[here])));
    mean += slow[i] / n;
  }
  std::vector<double> clock{0};
  for (int i = 0; i + 1 < n; ++i)
    clock.push_back(clock.back() + kLeastShare * mean + (slow[i] + slow[i + 1]) / 2);
  return clock;
}

Points rows_of(const Eigen::MatrixX2d& samples, bool closed) {
  Points points;
  for (Eigen::Index i = 0; i < samples.rows(); ++i) points.emplace_back(samples.row(i).transpose());
  if (closed) points.push_back(points.front());
  return points;
}

}  // namespace

TimedStroke in_equal_times(const Points& points, bool closed) {
  Points chain = points;
  if (closed) chain.push_back(points.front());
  constexpr int kFewest = 300;
  const int count = std::clamp(static_cast<int>(points.size()), kFewest, kMostSamples);
  const std::vector<double> lengths = length_clock(chain);
  Points even = rows_of(sampled(chain, lengths, 2 * count, closed), closed);
  std::vector<double> bends = bends_clock(even);
  const std::array<std::pair<const Points*, std::vector<double>>, 3> guesses{
      {{&chain, steps_clock(chain)}, {&chain, lengths}, {&even, std::move(bends)}}};
  TremorBand band;
  std::size_t best = 0;
  for (std::size_t g = 0; g < guesses.size(); ++g) {
    const auto& [line, clock] = guesses[g];
    const TremorBand found = band_of(powers(sampled(*line, clock, count, closed), closed));
    if (g > 0 && found.between >= band.between) continue;
    best = g;
    band = found;
  }
  constexpr double kSamplesPerWave = 10;
  constexpr int kFewSamples = 64;
  const int samples =
      std::clamp(static_cast<int>(kSamplesPerWave * band.waves), kFewSamples, kMostSamples);
  return {sampled(*guesses[best].first, guesses[best].second, samples, closed), band};
}

}  // namespace geoprior::sketch
