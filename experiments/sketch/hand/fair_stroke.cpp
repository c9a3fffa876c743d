#include "experiments/sketch/hand/fair_stroke.h"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/geometry/planar.h"
#include "experiments/sketch/hand/tremor_band.h"

namespace geoprior::sketch {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr int kOrder = 4;  ///< of the differences that are penalised
constexpr int kMostCorners = 20;
constexpr int kMostPoints = 400;  ///< of a faired stroke, beside its corners

/// Gain of the smoothing at k waves when it is a half at `cut` waves.
double gain_of(double k, double cut, int order) { return 1 / (1 + std::pow(k / cut, 2 * order)); }

/// Standard deviation of the tremor that such a cut leaves, over all of it.
double share_left(const TremorBand& band, double cut) {
  double left = 0, all = 0;
  for (int k = 1; k < 3 * band.waves; ++k) {
    const double off = (k - band.waves) / std::max(band.spread, 0.5);
    const double power = std::exp(-off * off / 2), gain = gain_of(k, cut, kOrder);
    left += power * gain * gain;
    all += power;
  }
  return all > 0 ? std::sqrt(left / all) : 0;
}

/// 0.3 of the tremor's waves, or as little more than 0.2 as leaves 3 % of a wide band.
double cut_below(const TremorBand& band) {
  constexpr double kHighest = 0.3, kLowest = 0.2, kShare = 0.03, kStep = 0.01;
  double cut = kHighest;
  while (cut > kLowest && share_left(band, cut * band.waves) > kShare) cut -= kStep;
  return cut * band.waves;
}

Eigen::MatrixXd second_differences(const Eigen::MatrixXd& x, bool closed) {
  const int n = static_cast<int>(x.rows());
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(n, x.cols());
  for (int i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i)
    d.row(i) = x.row((i + n - 1) % n) - 2 * x.row(i) + x.row((i + 1) % n);
  return d;
}

/// Minimises sum |x_i - y_i|^2 + lambda sum |D^order x|^2 for samples y.
class Smoothing {
 public:
  /// @param cut  waves along the samples at which the gain is a half
  Smoothing(int samples, bool closed, int order, double cut)
      : n_(samples),
        closed_(closed),
        order_(order),
        lambda_(std::pow(2 * std::sin(std::numbers::pi * cut / samples), -2 * order)) {
    std::vector<double> weights{1};
    for (int i = 0; i < order; ++i) {
      weights.push_back(0);
      for (std::size_t a = weights.size() - 1; a > 0; --a) weights[a] = weights[a - 1] - weights[a];
      weights[0] = -weights[0];
    }
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n_; ++i) {
      entries.emplace_back(i, i, 1);
      if (!closed && i + order >= n_) continue;
      for (int a = 0; a <= order; ++a) {
        for (int b = 0; b <= order; ++b)
          entries.emplace_back((i + a) % n_, (i + b) % n_, lambda_ * weights[a] * weights[b]);
      }
    }
    Eigen::SparseMatrix<double> matrix(n_, n_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(matrix);
  }

  [[nodiscard]] Eigen::MatrixXd of(const Eigen::MatrixXd& y) const { return factor_.solve(y); }

  /// What a kink's second difference of 1 in the middle becomes.
  [[nodiscard]] Eigen::VectorXd pulse() const { return of(unit()); }
  /// What smoothing takes off that kink: (1 - A^-1) of it, lambda A^-1 (D^2)^(order - 1) of a unit.
  [[nodiscard]] Eigen::VectorXd taken_off() const {
    Eigen::MatrixXd d = unit();
    for (int i = 1; i < order_; ++i) d = second_differences(d, closed_);
    return (order_ % 2 == 0 ? lambda_ : -lambda_) * of(d);
  }

 private:
  [[nodiscard]] Eigen::MatrixXd unit() const {
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(n_, 1);
    u(n_ / 2) = 1;
    return u;
  }

  int n_;
  bool closed_;
  int order_;
  double lambda_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

/// An open stroke goes on beyond its ends as it came, turned about them; where it ends is told by
/// a stiffer smoothing of a low order, since a fair curve's end is nearly straight.
Eigen::MatrixXd with_ends(const Eigen::MatrixXd& y, int more, double cut) {
  const int n = static_cast<int>(y.rows());
  const Eigen::MatrixXd line = Smoothing(n, false, 2, cut).of(y);
  Eigen::MatrixXd longer(n + 2 * more, 2);
  longer.middleRows(more, n) = y;
  for (int i = 1; i <= more; ++i) {
    longer.row(more - i) = 2 * line.row(0) - y.row(i);
    longer.row(more + n - 1 + i) = 2 * line.row(n - 1) - y.row(n - 1 - i);
  }
  return longer;
}

/// Kinks of a curve that is known only below a cut.
struct Kinks {
  std::vector<int> at;
  Eigen::MatrixXd sizes;  ///< second difference of each
};

/// Finds kinks in the second differences of a smoothed curve, in which each is a pulse.
class KinkSearch {
 public:
  /// @param half_wave  of the cut, samples: nearer kinks are one
  KinkSearch(Eigen::MatrixXd bends, Eigen::VectorXd pulse, bool closed, int half_wave)
      : bends_(std::move(bends)),
        pulse_(std::move(pulse)),
        n_(static_cast<int>(bends_.rows())),
        closed_(closed),
        half_wave_(half_wave) {}

  /// @param first,last  samples that may be kinks
  /// @param least       of a second difference of the smoothed curve
  /// @param turned      least second difference of a kink
  Kinks find(int first, int last, double least, double turned) {
    std::vector<char> open(n_, 0);
    std::fill(open.begin() + first, open.begin() + last + 1, char{1});
    Eigen::MatrixXd left = bends_;
    Kinks kinks;
    while (std::ssize(kinks.at) < kMostCorners) {
      int best = -1;
      double most = least;
      for (int i = first; i <= last; ++i) {
        if (open[i] && left.row(i).norm() > most) {
          most = left.row(i).norm();
          best = i;
        }
      }
      if (best < 0) break;
      for (int by = -half_wave_; by <= half_wave_; ++by) {
        if (inside(best + by)) open[wrapped(best + by)] = 0;
      }
      if (most < turned * pulse_(n_ / 2) || !is_pulse(left, best)) continue;
      kinks.at.push_back(best);
      fit(kinks);
      left = bends_;
      for (std::size_t k = 0; k < kinks.at.size(); ++k) {
        for (int i = 0; i < n_; ++i) left.row(i) -= shape(i, kinks.at[k]) * kinks.sizes.row(k);
      }
    }
    return kinks;
  }

  /// Sample `i` of what stands in the middle of `of`, brought to `at`.
  [[nodiscard]] double moved(const Eigen::VectorXd& of, int i, int at) const {
    const int from = i - at + n_ / 2;
    if (closed_) return of(wrapped(from));
    return from < 0 || from >= n_ ? 0 : of(from);
  }

 private:
  [[nodiscard]] int wrapped(int i) const { return (i % n_ + n_) % n_; }
  [[nodiscard]] bool inside(int i) const { return closed_ || (i >= 0 && i < n_); }
  [[nodiscard]] double shape(int i, int at) const { return moved(pulse_, i, at); }

  /// Whether a pulse makes up half of what is there.
  [[nodiscard]] bool is_pulse(const Eigen::MatrixXd& bends, int at) const {
    double all = 0, rest = 0;
    for (int by = -half_wave_; by <= half_wave_; ++by) {
      if (!inside(at + by)) continue;
      const Eigen::RowVector2d here = bends.row(wrapped(at + by));
      all += here.squaredNorm();
      rest += (here - shape(at + by, at) / pulse_(n_ / 2) * bends.row(at)).squaredNorm();
    }
    return rest <= all / 2;
  }
  /// Sizes with which all pulses together are the second differences at the kinks.
  void fit(Kinks& kinks) const {
    const int count = static_cast<int>(kinks.at.size());
    Eigen::MatrixXd overlaps(count, count), there(count, 2);
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) overlaps(a, b) = shape(kinks.at[a], kinks.at[b]);
      there.row(a) = bends_.row(kinks.at[a]);
    }
    kinks.sizes = overlaps.partialPivLu().solve(there);
  }

  Eigen::MatrixXd bends_;
  Eigen::VectorXd pulse_;
  int n_;
  bool closed_;
  int half_wave_;
};

/// Largest second difference that tremor leaves anywhere on a smoothed curve, or hardly more. What
/// is between the shape and the tremor may be either's.
double noisy_bend(const TremorBand& band, double cut, int samples) {
  double tremor = 0, all = 0, between = 0;
  for (int k = 1; k < 3 * band.waves; ++k) {
    const double off = (k - band.waves) / std::max(band.spread, 0.5);
    const double power = std::exp(-off * off / 2);
    const double squared = std::pow(2 * std::sin(std::numbers::pi * k / samples), 2);
    const double bend = std::pow(gain_of(k, cut, kOrder) * squared, 2);
    tremor += power * bend;
    all += power;
    if (k < band.waves / 2) between += bend / (band.waves / 4);
  }
  // Squares of normal noise in two coordinates are exponentially distributed: the largest of so
  // many independent ones is about ln (their number) means.
  constexpr double kAbove = 5;
  const double share = all > 0 ? tremor / all : 0;
  const double mean = 2 * band.sigma * band.sigma * (share + band.between * between);
  return std::sqrt(mean * (std::log(2 * cut + 1) + kAbove));
}

double largest_distance(const Points& from, const Points& to) {
  double largest = 0;
  for (const Eigen::Vector2d& p : from) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < to.size(); ++i) {
      const Eigen::Vector2d along = to[i + 1] - to[i];
      const double squared = along.squaredNorm();
      const double t = squared > 0 ? std::clamp((p - to[i]).dot(along) / squared, 0.0, 1.0) : 0;
      least = std::min(least, (p - to[i] - t * along).squaredNorm());
    }
    largest = std::max(largest, least);
  }
  return std::sqrt(largest);
}

/// Faired samples and which of them are corners.
struct FairedSamples {
  Eigen::MatrixXd x;
  std::vector<int> corners;  ///< ascending
};
FairedSamples faired_samples(const TimedStroke& stroke, bool closed) {
  const int count = static_cast<int>(stroke.samples.rows());
  const double cut = cut_below(stroke.band);
  const int wave = static_cast<int>(std::ceil(count / cut));
  const int more = closed ? 0 : std::min(count - 1, 2 * wave);
  const Eigen::MatrixXd y =
      closed ? Eigen::MatrixXd(stroke.samples) : with_ends(stroke.samples, more, cut);
  const int n = static_cast<int>(y.rows());
  const Smoothing smoothing(n, closed, kOrder, cut * n / count);
  Eigen::MatrixXd x = smoothing.of(y);
  double step = 0;
  for (int i = more; i + 1 < more + count; ++i) step += (x.row(i + 1) - x.row(i)).norm() / count;
  constexpr double kLeastTurn = 0.4;  // rad
  const int margin = closed ? 0 : std::min(wave / 2, (count - 1) / 2);
  KinkSearch search(second_differences(x, closed), smoothing.pulse(), closed, wave / 2);
  const Kinks kinks = search.find(more + margin, more + count - 1 - margin,
                                  noisy_bend(stroke.band, cut, count), kLeastTurn * step);
  const Eigen::VectorXd taken_off = smoothing.taken_off();
  FairedSamples faired;
  for (std::size_t k = 0; k < kinks.at.size(); ++k) {
    for (int i = 0; i < n; ++i)
      x.row(i) += search.moved(taken_off, i, kinks.at[k]) * kinks.sizes.row(k);
    faired.corners.push_back(kinks.at[k] - more);
  }
  faired.x = x.middleRows(more, count);
  std::sort(faired.corners.begin(), faired.corners.end());
  return faired;
}

}  // namespace

bool is_trembling(const Points& points, bool closed, int changes) {
  constexpr double kTurn = 0.05;  // rad: less is rounding of a straight line's points
  if (std::ssize(points) < 2 * changes) return false;
  Points chain = points;
  if (closed) chain.push_back(points.front());
  int found = 0;
  double last = 0;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    const double turn = signed_angle(chain[i] - chain[i - 1], chain[i + 1] - chain[i]);
    if (std::abs(turn) < kTurn) continue;
    if (turn * last < 0) ++found;
    last = turn;
  }
  return found >= changes;
}

std::optional<FairedStroke> fair_stroke(const Points& points, bool closed, int changes) {
  if (!is_trembling(points, closed, changes)) return std::nullopt;
  const TimedStroke stroke = in_equal_times(points, closed);
  const FairedSamples samples = faired_samples(stroke, closed);
  const int count = static_cast<int>(samples.x.rows());
  const int step = (count + kMostPoints - 1) / kMostPoints;
  FairedStroke faired;
  for (int i = 0; i < count; ++i) {
    const bool corner = std::binary_search(samples.corners.begin(), samples.corners.end(), i);
    if (corner) faired.corners.emplace_back(samples.x.row(i).transpose());
    if (corner || i % step == 0 || (!closed && i + 1 == count))
      faired.points.emplace_back(samples.x.row(i).transpose());
  }
  faired.noise = std::sqrt((stroke.samples - samples.x).squaredNorm() / (2.0 * count));
  Points chain = faired.points;
  if (closed) chain.push_back(faired.points.front());
  faired.moved = largest_distance(points, chain);
  return faired;
}

}  // namespace geoprior::sketch
