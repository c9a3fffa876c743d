#include "models/sketch/drawing/fair_stroke.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/geometry/planar.h"
#include "models/sketch/drawing/polyline.h"

namespace geoprior::sketch {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr int kSplinePoints = 400;  ///< of a stroke
constexpr int kLeftOut = 3;         ///< neighbours on each side that are left out with a point
constexpr int kMostCorners = 16;
constexpr int kLambdaSteps = 10;   ///< of the logarithm of lambda, two to a decade
constexpr int kStepsBelow = 2;     ///< steps below the best lambda that are taken
constexpr double kAboveNoise = 3;  ///< of a corner's gain over what noise gives, over its mean

double lambda_of(int step) { return std::pow(10.0, step / 2.0); }

Points chain_of(const Points& points, bool closed) {
  Points chain = points;
  if (closed) chain.push_back(points.front());
  return chain;
}

/// Points at equal distances: kSplinePoints of a closed stroke, one more of an open one.
Eigen::MatrixX2d even_samples(const Points& chain, bool closed) {
  const double whole = length(chain);
  Eigen::MatrixX2d samples(kSplinePoints + (closed ? 0 : 1), 2);
  double before = 0;
  std::size_t segment = 0;
  for (Eigen::Index i = 0; i < samples.rows(); ++i) {
    const double at = whole * static_cast<double>(i) / kSplinePoints;
    double size = (chain[segment + 1] - chain[segment]).norm();
    while (segment + 2 < chain.size() && before + size < at) {
      before += size;
      ++segment;
      size = (chain[segment + 1] - chain[segment]).norm();
    }
    const double t = size > 0 ? std::clamp((at - before) / size, 0.0, 1.0) : 0;
    samples.row(i) = (chain[segment] + t * (chain[segment + 1] - chain[segment])).transpose();
  }
  return samples;
}

class SmoothingSpline {
 public:
  SmoothingSpline(Eigen::MatrixX2d y, bool closed)
      : y_(std::move(y)), closed_(closed), n_(static_cast<int>(y_.rows())) {}

  /// Minimises for these corners; the other members speak of the last one.
  void solve(int step, const std::vector<int>& corners) {
    lambda_ = lambda_of(step);
    free_.assign(n_, static_cast<char>(closed_ ? 0 : 1));
    if (!closed_) std::fill(free_.begin() + 1, free_.end() - 1, char{0});
    for (const int c : corners) free_[c] = 1;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n_; ++i) {
      entries.emplace_back(i, i, 1);
      if (free_[i]) continue;
      for (int a = -1; a <= 1; ++a) {
        for (int b = -1; b <= 1; ++b)
          entries.emplace_back(at(i + a), at(i + b), lambda_ * weight(a) * weight(b));
      }
    }
    Eigen::SparseMatrix<double> matrix(n_, n_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(matrix);
    x_ = factor_.solve(y_);
  }
  void invert() { inverse_ = factor_.solve(Eigen::MatrixXd::Identity(n_, n_)); }

  /// Mean square error of points that are predicted without their block. Needs `invert`.
  [[nodiscard]] double cross_validation() const {
    constexpr int kSize = 2 * kLeftOut + 1;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < n_; ++i) {
      if (!closed_ && (i < kLeftOut || i + kLeftOut >= n_)) continue;
      Eigen::Matrix<double, kSize, kSize> left;
      Eigen::Matrix<double, kSize, 2> residual;
      for (int a = 0; a < kSize; ++a) {
        const int row = at(i + a - kLeftOut);
        residual.row(a) = y_.row(row) - x_.row(row);
        for (int b = 0; b < kSize; ++b)
          left(a, b) = (a == b ? 1 : 0) - inverse_(row, at(i + b - kLeftOut));
      }
      const Eigen::Matrix<double, kSize, 2> missed = left.partialPivLu().solve(residual);
      sum += missed.row(kLeftOut).squaredNorm();
      ++count;
    }
    return sum / count;
  }

  /// By how much freeing a point would lower the minimum. Needs `invert`.
  [[nodiscard]] double gain(int i) const {
    if (free_[i]) return 0;
    double spread = 0;
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b)
        spread += weight(a) * weight(b) * inverse_(at(i + a), at(i + b));
    }
    return lambda_ * bend(i).squaredNorm() / std::max(1 - lambda_ * spread, 1e-9);
  }

  [[nodiscard]] double minimum() const {
    double sum = (y_ - x_).squaredNorm();
    for (int i = 0; i < n_; ++i) sum += free_[i] ? 0 : lambda_ * bend(i).squaredNorm();
    return sum;
  }

  [[nodiscard]] int size() const { return n_; }
  [[nodiscard]] int at(int i) const { return (i % n_ + n_) % n_; }
  [[nodiscard]] bool inside(int i) const { return closed_ || (i > 0 && i + 1 < n_); }
  [[nodiscard]] int apart(int a, int b) const {
    const int d = std::abs(a - b);
    return closed_ ? std::min(d, n_ - d) : d;
  }
  [[nodiscard]] const Eigen::MatrixX2d& x() const { return x_; }
  [[nodiscard]] const Eigen::MatrixX2d& y() const { return y_; }

 private:
  static double weight(int a) { return a == 0 ? -2 : 1; }
  [[nodiscard]] Eigen::RowVector2d bend(int i) const {
    return x_.row(at(i - 1)) - 2 * x_.row(i) + x_.row(at(i + 1));
  }

  Eigen::MatrixX2d y_, x_;
  bool closed_;
  int n_;
  double lambda_ = 1;
  std::vector<char> free_;  ///< of every point, whether its second difference costs nothing
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::MatrixXd inverse_;
};

/// Step of the lambda that predicts best, of those from `low` to `high`.
int best_step(SmoothingSpline& spline, const std::vector<int>& corners, int low, int high) {
  int best = low;
  double least = std::numeric_limits<double>::infinity();
  for (int step = std::max(low, 1); step <= std::min(high, kLambdaSteps); ++step) {
    spline.solve(step, corners);
    spline.invert();
    const double error = spline.cross_validation();
    if (error < least) {
      least = error;
      best = step;
    }
  }
  return best;
}

/// The point that is a corner with most confidence; -1 when noise may make as much.
int next_corner(SmoothingSpline& spline, int step, const std::vector<int>& corners) {
  spline.solve(step, corners);
  spline.invert();
  const int n = spline.size();
  std::vector<double> gains(n);
  for (int i = 0; i < n; ++i) gains[i] = spline.gain(i);
  std::vector<double> sorted = gains;
  std::nth_element(sorted.begin(), sorted.begin() + n / 2, sorted.end());
  // Gains of normal noise in two coordinates are exponentially distributed: ln 2 of the mean is
  // their median, and the largest of so many independent ones about ln (their number) means.
  const double mean = sorted[n / 2] / std::numbers::ln2;
  const int reach =
      std::max(3, static_cast<int>(std::lround(1.5 * std::sqrt(std::sqrt(lambda_of(step))))));
  int best = -1;
  for (int i = 0; i < n; ++i) {
    const bool near = std::any_of(corners.begin(), corners.end(),
                                  [&](int c) { return spline.apart(i, c) <= reach; });
    if (!near && (best < 0 || gains[i] > gains[best])) best = i;
  }
  const double places = static_cast<double>(n) / reach;
  return best >= 0 && gains[best] > mean * (std::log(places) + kAboveNoise) ? best : -1;
}

/// Moves each corner to where the minimum is lowest.
void settle_corners(SmoothingSpline& spline, int step, std::vector<int>& corners) {
  spline.solve(step, corners);
  double least = spline.minimum();
  for (int sweep = 0; sweep < 2; ++sweep) {
    for (int& corner : corners) {
      const int before = corner;
      int best = before;
      for (const int by : {-2, -1, 1, 2}) {
        if (!spline.inside(before + by)) continue;
        corner = spline.at(before + by);
        spline.solve(step, corners);
        if (spline.minimum() < least) {
          least = spline.minimum();
          best = corner;
        }
      }
      corner = best;
    }
  }
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

}  // namespace

bool is_trembling(const Points& points, bool closed) {
  constexpr std::size_t kFewPoints = 60;
  constexpr int kFewChanges = 30;
  constexpr double kTurn = 0.05;  // rad: less is rounding of a straight line's points
  if (points.size() < kFewPoints) return false;
  const Points chain = chain_of(points, closed);
  int changes = 0;
  double last = 0;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    const double turn = signed_angle(chain[i] - chain[i - 1], chain[i + 1] - chain[i]);
    if (std::abs(turn) < kTurn) continue;
    if (turn * last < 0) ++changes;
    last = turn;
  }
  return changes >= kFewChanges;
}

std::optional<FairedStroke> fair_stroke(const Points& points, bool closed) {
  if (!is_trembling(points, closed)) return std::nullopt;
  const Points chain = chain_of(points, closed);
  SmoothingSpline spline(even_samples(chain, closed), closed);
  std::vector<int> corners;
  int step = best_step(spline, corners, 1, kLambdaSteps);
  while (std::ssize(corners) < kMostCorners) {
    const int corner = next_corner(spline, step, corners);
    if (corner < 0) break;
    corners.push_back(corner);
    step = best_step(spline, corners, step - 1, step + 1);
  }
  settle_corners(spline, std::max(step - 1, 1), corners);
  spline.solve(std::max(step - kStepsBelow, 0), corners);
  FairedStroke faired;
  for (Eigen::Index i = 0; i < spline.x().rows(); ++i)
    faired.points.emplace_back(spline.x().row(i).transpose());
  std::sort(corners.begin(), corners.end());
  for (const int c : corners) faired.corners.push_back(faired.points[c]);
  faired.noise = std::sqrt((spline.y() - spline.x()).squaredNorm() / (2.0 * spline.size()));
  faired.moved = largest_distance(points, chain_of(faired.points, closed));
  return faired;
}

}  // namespace geoprior::sketch
