#include "metrics/sound/power_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior {
namespace {

constexpr int kMostCandidates = 50;  ///< ranks tried for E_min

/// The density proportional to exp(-tilt t) on [0, 1]: a power law in log E, an exponential in E.
struct Tilted {
  double tilt = 0;

  [[nodiscard]] double mean() const {
    if (std::abs(tilt) < 0.05) return 0.5 - tilt / 12 + tilt * tilt * tilt / 720;
    return 1 / tilt - 1 / std::expm1(tilt);
  }
  [[nodiscard]] double variance() const {
    if (std::abs(tilt) < 0.05) return 1. / 12 - tilt * tilt / 240;
    const double s = 2 * std::sinh(tilt / 2);
    return 1 / (tilt * tilt) - 1 / (s * s);
  }
  /// log of the integral of exp(-tilt t)
  [[nodiscard]] double log_integral() const {
    if (tilt == 0) return 0;
    const double size = std::abs(tilt);
    return std::log(-std::expm1(-size) / size) + (tilt < 0 ? size : 0);
  }
  [[nodiscard]] Eigen::ArrayXd cumulative(const Eigen::ArrayXd& t) const {
    if (std::abs(tilt) < 1e-7) return t;
    return (1 - (-tilt * t).exp()) / -std::expm1(-tilt);
  }
  [[nodiscard]] double quantile(double share) const {
    if (std::abs(tilt) < 1e-7) return share;
    return -std::log1p(share * std::expm1(-tilt)) / tilt;
  }
};

/// The one of that mean, 0 < mean < 1: its maximum likelihood. Newton's steps from 0 approach the
/// root from one side, as the mean is convex in a positive tilt.
Tilted tilted_of_mean(double mean) {
  if (mean > 0.5) return {-tilted_of_mean(1 - mean).tilt};
  Tilted law;
  for (int step = 0; step < 100; ++step) {
    const double move = (law.mean() - mean) / law.variance();
    law.tilt += move;
    if (std::abs(move) <= 1e-12 * (1 + law.tilt)) break;
  }
  return law;
}

/// Values from a rank on: t = 0 is the smallest of them, t = 1 the largest.
struct EnergyTail {
  Eigen::Index start = 0;
  double length = 0;  ///< log of largest over smallest
  Tilted law;
  double ks = std::numeric_limits<double>::infinity();
};

Eigen::ArrayXd tail_coordinates(const Eigen::VectorXd& logs, Eigen::Index start, double length) {
  return (logs.tail(logs.size() - start).array() - logs(start)) / length;
}

double ks_distance(const Eigen::ArrayXd& sorted, const Tilted& law) {
  const auto n = static_cast<double>(sorted.size());
  const Eigen::ArrayXd expected = law.cumulative(sorted);
  const Eigen::ArrayXd below = Eigen::ArrayXd::LinSpaced(sorted.size(), 0, (n - 1) / n);
  return std::max((expected - below).maxCoeff(), (below + 1 / n - expected).maxCoeff());
}

/// Of the tails that start at rank 0 … last, that of least distance from its power law.
/// @param logs  ascending
EnergyTail nearest_tail(const Eigen::VectorXd& logs, Eigen::Index last) {
  const Eigen::Index step = last / kMostCandidates + 1;
  EnergyTail best;
  for (Eigen::Index start = 0; start <= last; start += step) {
    EnergyTail tail{start, logs(logs.size() - 1) - logs(start), {}, 0};
    const bool in_a_tie = start > 0 && logs(start) == logs(start - 1);
    if (in_a_tie || !(tail.length > 0)) continue;
    const Eigen::ArrayXd t = tail_coordinates(logs, start, tail.length);
    tail.law = tilted_of_mean(t.mean());
    tail.ks = ks_distance(t, tail.law);
    if (tail.ks < best.ks) best = tail;
  }
  return best;
}

/// Share of the samples of the fitted law that lie at least as far from their own fit.
double bootstrap_p_value(const Eigen::VectorXd& logs, Eigen::Index last, const EnergyTail& tail,
                         const PowerLawOptions& options) {
  const auto n = static_cast<double>(logs.size());
  const double share = static_cast<double>(logs.size() - tail.start) / n;
  std::vector<char> is_as_far(options.replicates, 0);
  parallel_blocks(is_as_far.size(), 8, [&](std::size_t begin, std::size_t end) {
    Eigen::VectorXd sample(logs.size());
    for (std::size_t r = begin; r < end; ++r) {
      RandomStream random(options.seed, static_cast<std::uint64_t>(r));
      for (double& value : sample) {
        const bool in_tail = tail.start == 0 || random.uniform() < share;
        value = in_tail ? logs(tail.start) + tail.length * tail.law.quantile(random.uniform())
                        : logs(random.below(static_cast<std::uint32_t>(tail.start)));
      }
      std::sort(sample.begin(), sample.end());
      is_as_far[r] = nearest_tail(sample, last).ks >= tail.ks ? 1 : 0;
    }
  });
  return static_cast<double>(std::count(is_as_far.begin(), is_as_far.end(), 1)) /
         options.replicates;
}

/// The density proportional to exp(-tilt t - bend t^2) on [0, 1]: a log-normal in log E when the
/// bend is positive.
struct LogQuadratic {
  double tilt = 0, bend = 0;
  double log_integral = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< of t and t^2
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  /// Moments by Simpson's rule.
  LogQuadratic(double tilt_in, double bend_in) : tilt(tilt_in), bend(bend_in) {
    constexpr int kIntervals = 512;
    const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(kIntervals + 1, 0, 1);
    const Eigen::ArrayXd power = -tilt * t - bend * t.square();
    const double most = power.maxCoeff();
    Eigen::ArrayXd weight = (power - most).exp() / (3. * kIntervals);
    for (int i = 1; i < kIntervals; ++i) weight(i) *= i % 2 == 1 ? 4 : 2;
    const double integral = weight.sum();
    log_integral = std::log(integral) + most;
    weight /= integral;
    mean << (weight * t).sum(), (weight * t.square()).sum();
    const double third = (weight * t.cube()).sum(), fourth = (weight * t.square().square()).sum();
    covariance << mean(1), third, third, fourth;
    covariance -= mean * mean.transpose();
  }
  /// Mean log-likelihood of values of these means of t and t^2.
  [[nodiscard]] double likelihood(const Eigen::Vector2d& of) const {
    return -tilt * of(0) - bend * of(1) - log_integral;
  }
};

/// Of maximum likelihood, by Newton's method with halved steps on a concave function.
LogQuadratic log_quadratic_of_means(const Eigen::Vector2d& means, double tilt) {
  LogQuadratic law(tilt, 0);
  for (int step = 0; step < 100; ++step) {
    const Eigen::Matrix2d& c = law.covariance;
    const Eigen::Vector2d lack = law.mean - means;
    const double determinant = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1);
    const Eigen::Vector2d move((c(1, 1) * lack(0) - c(0, 1) * lack(1)) / determinant,
                               (c(0, 0) * lack(1) - c(0, 1) * lack(0)) / determinant);
    double scale = 1;
    LogQuadratic next(law.tilt + move(0), law.bend + move(1));
    while (!(next.likelihood(means) >= law.likelihood(means)) && scale > 1e-6) {
      scale /= 2;
      next = LogQuadratic(law.tilt + scale * move(0), law.bend + scale * move(1));
    }
    if (!(next.likelihood(means) > law.likelihood(means))) break;
    law = next;
    if (scale * move.norm() < 1e-9 * (1 + std::abs(law.tilt))) break;
  }
  return law;
}

/// Quantile of the standard normal distribution by bisection of its tail.
double normal_quantile_above(double tail_share) {
  double low = -10, high = 10;
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::numbers::sqrt2) / 2 > tail_share ? low : high) = middle;
  }
  return low;
}

void compare_lognormal(const Eigen::ArrayXd& t, const EnergyTail& tail,
                       const PowerLawOptions& options, PowerLawFit& fit) {
  const auto n = static_cast<double>(t.size());
  const Eigen::Vector2d means(t.mean(), t.square().mean());
  const LogQuadratic rival = log_quadratic_of_means(means, tail.law.tilt);
  const double power_law = -tail.law.tilt * means(0) - tail.law.log_integral();
  if (rival.bend > 0) {
    fit.log_ratio_lognormal = std::min(0., n * (power_law - rival.likelihood(means)));
  }
  fit.p_lognormal = rival.bend > 0 ? std::erfc(std::sqrt(-fit.log_ratio_lognormal)) / 2 : 0.5;
  const Eigen::Matrix2d& c = rival.covariance;
  const double bend_error = std::sqrt(c(0, 0) / (c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1)) / n);
  fit.exponent_change = 2 * rival.bend / tail.length;
  fit.exponent_change_error = 2 * bend_error / tail.length;
  const double most = rival.bend + normal_quantile_above(options.significance) * bend_error;
  if (most > 0) fit.least_sigma = tail.length / std::sqrt(2 * most);
}

/// Vuong's ratio against the exponential on the same interval.
void compare_exponential(const Eigen::ArrayXd& t, const EnergyTail& tail, PowerLawFit& fit) {
  const auto n = static_cast<double>(t.size());
  const double width = std::expm1(tail.length);  // (E_max - E_min) / E_min
  const Eigen::ArrayXd s = ((tail.length * t).exp() - 1) / width;
  const Tilted rival = tilted_of_mean(s.mean());
  // Both as densities of E / E_min, whose logarithm is `length` t.
  const Eigen::ArrayXd ratios = -tail.law.tilt * t - tail.law.log_integral() -
                                std::log(tail.length) - tail.length * t + rival.tilt * s +
                                rival.log_integral() + std::log(width);
  fit.log_ratio_exponential = ratios.sum();
  const double spread = std::sqrt((ratios - ratios.mean()).square().mean());
  fit.p_exponential = std::erfc(std::abs(fit.log_ratio_exponential) /
                                (spread * std::sqrt(n) * std::numbers::sqrt2));
}

/// Ranks from 0 on; equal values share the mean of theirs.
Eigen::ArrayXd shared_ranks(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> order(values.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return values(a) < values(b); });
  Eigen::ArrayXd ranks(values.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values(order[end]) == values(order[first])) ++end;
    for (std::size_t i = first; i < end; ++i) {
      ranks(order[i]) = static_cast<double>(first + end - 1) / 2;
    }
  }
  return ranks;
}

/// Spearman's correlation of each value with the next; 0 when all are equal.
double serial_rank_correlation(const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  const Eigen::ArrayXd ranks = shared_ranks(values);
  const Eigen::ArrayXd centred = ranks - ranks.mean();
  const double squares = centred.square().sum();
  if (!(squares > 0)) return 0;
  return (centred.head(n - 1) * centred.tail(n - 1)).sum() / squares;
}

std::string reason_to_withhold(const PowerLawFit& fit, const PowerLawOptions& options) {
  if (fit.p_value < options.least_p_value) {
    return "no power law: p value " + std::to_string(fit.p_value) + " is below " +
           std::to_string(options.least_p_value);
  }
  if (fit.p_lognormal < options.significance) {
    return "a log-normal is likelier: log ratio " + std::to_string(fit.log_ratio_lognormal) +
           ", p " + std::to_string(fit.p_lognormal);
  }
  const double z = normal_quantile_above(options.significance);
  if (!(fit.exponent_change + z * fit.exponent_change_error <= options.most_exponent_change)) {
    return "a log-normal is not told apart: over the tail the exponent changes by " +
           std::to_string(fit.exponent_change) + " +- " + std::to_string(fit.exponent_change_error);
  }
  if (!(fit.log_ratio_exponential > 0) || !(fit.p_exponential < options.significance)) {
    return "an exponential is not told apart: log ratio " +
           std::to_string(fit.log_ratio_exponential) + ", p " + std::to_string(fit.p_exponential);
  }
  if (fit.serial_correlation > options.most_serial_correlation) {
    return "successive values depend on each other: rank correlation " +
           std::to_string(fit.serial_correlation);
  }
  return {};
}

/// Logarithms of the positive values.
Eigen::VectorXd positive_logarithms(const Eigen::Ref<const Eigen::VectorXd>& energies) {
  std::vector<double> logs;
  for (Eigen::Index i = 0; i < energies.size(); ++i) {
    if (!(energies(i) >= 0) || !std::isfinite(energies(i))) {
      throw Error(std::to_string(energies(i)) + " is no energy", "value " + std::to_string(i),
                  "finite, not negative");
    }
    if (energies(i) > 0) logs.push_back(std::log(energies(i)));
  }
  return Eigen::Map<Eigen::VectorXd>(logs.data(), logs.size());
}

/// The last rank from which on there are as many values, and as many decades, as asked for; -1:
/// there is none.
Eigen::Index last_start(const Eigen::VectorXd& logs, const PowerLawOptions& options) {
  const Eigen::Index n = logs.size();
  const auto needed =
      std::max(static_cast<Eigen::Index>(options.least_count),
               static_cast<Eigen::Index>(std::ceil(options.least_share * static_cast<double>(n))));
  Eigen::Index last = n - needed;
  while (last >= 0 && logs(n - 1) - logs(last) < options.least_decades * std::numbers::ln10) {
    --last;
  }
  return std::max<Eigen::Index>(last, -1);
}

}  // namespace

std::optional<double> PowerLawFit::stated_exponent() const {
  if (!withheld.empty()) return {};
  return exponent;
}

PowerLawFit fit_power_law(const Eigen::Ref<const Eigen::VectorXd>& energies,
                          const PowerLawOptions& options) {
  if (options.least_count < 3 || !(options.least_share >= 0) || !(options.least_share <= 1) ||
      !(options.least_decades > 0) || options.replicates < 1 || !(options.significance > 0) ||
      !(options.significance < 0.5)) {
    throw Error("least count " + std::to_string(options.least_count) + ", least share " +
                    std::to_string(options.least_share) + ", least decades " +
                    std::to_string(options.least_decades) + ", replicates " +
                    std::to_string(options.replicates) + ", significance " +
                    std::to_string(options.significance),
                "power law", "at least 3, 0 to 1, positive, positive, 0 to 0.5");
  }
  Eigen::VectorXd logs = positive_logarithms(energies);
  PowerLawFit fit;
  fit.serial_correlation = logs.size() < 2 ? 0 : serial_rank_correlation(logs);
  std::sort(logs.begin(), logs.end());
  fit.left_out = static_cast<int>(energies.size() - logs.size());
  const Eigen::Index last = last_start(logs, options);
  if (last < 0) {
    fit.withheld = "no tail of " + std::to_string(options.least_count) + " values and a share of " +
                   std::to_string(options.least_share) + " over " +
                   std::to_string(options.least_decades) + " decades among " +
                   std::to_string(logs.size());
    return fit;
  }
  const EnergyTail tail = nearest_tail(logs, last);
  const Eigen::ArrayXd t = tail_coordinates(logs, tail.start, tail.length);
  const double count = static_cast<double>(t.size());
  fit.count = static_cast<int>(t.size());
  fit.exponent = 1 + tail.law.tilt / tail.length;
  fit.standard_error = 1 / (tail.length * std::sqrt(count * tail.law.variance()));
  fit.e_min = std::exp(logs(tail.start));
  fit.e_max = std::exp(logs(logs.size() - 1));
  fit.decades = tail.length / std::numbers::ln10;
  fit.ks = tail.ks;
  fit.p_value = bootstrap_p_value(logs, last, tail, options);
  compare_lognormal(t, tail, options, fit);
  compare_exponential(t, tail, fit);
  fit.withheld = reason_to_withhold(fit, options);
  return fit;
}

}  // namespace geoprior
