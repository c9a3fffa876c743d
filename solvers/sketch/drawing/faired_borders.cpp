#include "solvers/sketch/drawing/faired_borders.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::sketch {
namespace {

/// Points of a line that is faired at least: fewer where its noise is known.
std::size_t least_points(double noise) { return noise > 0 ? 6 : 12; }
/// Chord that nineteen of twenty are shorter than, over the median.
constexpr double kUneven = 3.5;
/// Of the borders' diagonal: below it nothing trembles.
constexpr double kLeastTremor = 2e-4;
/// A corner turns by more between two chords of so many points, and of so many deviations of the
/// noise.
constexpr double kFairCorner = 60 * kDegree;
constexpr std::size_t kCornerPoints = 5;
constexpr double kCornerNoise = 8;
/// Deviations of a turn that noise may have added.
constexpr double kSureTurn = 1.5;

using LineMatrix = Eigen::SparseMatrix<double>;

/// Rows: third differences.
LineMatrix third_differences(int n, bool closed) {
  const int rows = closed ? n : n - 3;
  std::vector<Eigen::Triplet<double>> entries;
  for (int r = 0; r < rows; ++r) {
    constexpr std::array<double, 4> kThird{-1, 3, -3, 1};
    for (int k = 0; k < 4; ++k) entries.emplace_back(r, (r + k) % n, kThird[k]);
  }
  LineMatrix D(rows, n);
  D.setFromTriplets(entries.begin(), entries.end());
  return D;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Noise shortens single chords; a line of uneven distances has many that are long.
bool is_even(const std::vector<Eigen::Vector2d>& points, bool closed) {
  std::vector<double> chords;
  for (std::size_t i = closed ? 0 : 1; i < points.size(); ++i)
    chords.push_back((points[i] - points[(i + points.size() - 1) % points.size()]).norm());
  std::sort(chords.begin(), chords.end());
  return chords[chords.size() * 19 / 20] <= kUneven * chords[chords.size() / 2];
}

/// How much a line turns at a point, less what noise makes of it; 0 near its ends.
struct SureTurn {
  double angle = 0;
  std::size_t points = kCornerPoints;  ///< of the longer chord
};

/// Between the shortest chords that tell.
SureTurn sure_turn_at(const std::vector<Eigen::Vector2d>& points, std::size_t i, double noise) {
  SureTurn turn;
  const auto chord = [&](bool back) -> std::optional<Eigen::Vector2d> {
    for (std::size_t k = kCornerPoints; back ? k <= i : i + k < points.size(); ++k) {
      const Eigen::Vector2d d = back ? points[i] - points[i - k] : points[i + k] - points[i];
      if (d.norm() < kCornerNoise * noise) continue;
      turn.points = std::max(turn.points, k);
      return d;
    }
    return {};
  };
  const std::optional<Eigen::Vector2d> in = chord(true), out = chord(false);
  if (!in || !out) return turn;
  const double spread = std::sqrt(6.0) * noise / std::min(in->norm(), out->norm());
  turn.angle = std::abs(signed_angle(*in, *out)) - kSureTurn * spread;
  return turn;
}

/// Numbers of points between which a line has no corner, first and last of them included.
std::vector<std::size_t> smooth_parts(const std::vector<Eigen::Vector2d>& points, double noise) {
  const std::size_t n = points.size();
  std::vector<std::size_t> cuts{0};
  SureTurn sharpest;
  std::size_t corner = 0;
  for (std::size_t i = kCornerPoints; i + kCornerPoints < n; ++i) {
    const SureTurn turn = sure_turn_at(points, i, noise);
    if (turn.angle > kFairCorner && turn.angle > sharpest.angle) {
      sharpest = turn;
      corner = i;
    }
    // The sharpest of those whose chords pass it.
    if (corner > 0 && i >= corner + sharpest.points) {
      cuts.push_back(corner);
      corner = 0;
      sharpest = {};
    }
  }
  if (corner > 0) cuts.push_back(corner);
  cuts.push_back(n - 1);
  return cuts;
}

/// A stretch of a border without a corner.
struct BorderPart {
  std::size_t stroke = 0, begin = 0, end = 0;  ///< numbers of its first and its last point
  bool closed = false;
  std::array<bool, 2> hold{false, false};
};

/// The minimum of |x - y|^2 + lambda |third differences of x|^2, and how likely lambda is.
///
/// Third differences are taken for independent normal numbers of variance s^2 / lambda, noise for
/// independent of variance s^2. With r = rank D and q = y.(y - x) over both coordinates,
/// minus twice the logarithm of the likelihood of D y is, up to constants,
///   q / s^2 + 2 r log s^2 + 2 (log det (I + lambda D'D) - r log lambda),
/// which s^2 = q / (2 r) minimises (restricted maximum likelihood: Wahba 1985).
class SmoothedLine {
 public:
  SmoothedLine(const std::vector<Eigen::Vector2d>& points, bool closed)
      : y_(points.size(), 2), n_(static_cast<int>(points.size())), closed_(closed) {
    for (int i = 0; i < n_; ++i) y_.row(i) = points[static_cast<std::size_t>(i)].transpose();
    D_ = third_differences(n_, closed);
    DtD_ = D_.transpose() * D_;
    weight_ = Eigen::VectorXd::Ones(n_);
    x_ = y_;
    LineMatrix pattern = DtD_;
    for (int i = 0; i < n_; ++i) pattern.coeffRef(i, i) += 1;
    factor_.analyze(pattern);
  }

  /// Standard deviation from the median third difference.
  [[nodiscard]] double tremor() const {
    const Eigen::MatrixX2d third = D_ * y_;
    std::vector<double> sizes;
    for (Eigen::Index r = 0; r < third.rows(); ++r)
      for (int k = 0; k < 2; ++k) sizes.push_back(std::abs(third(r, k)));
    return median_of(std::move(sizes)) / (0.6745 * std::sqrt(20.0));
  }

  void solve(double logarithm) {
    logarithm_ = logarithm;
    LineMatrix A = std::pow(10.0, logarithm) * DtD_;
    for (int i = 0; i < n_; ++i) A.coeffRef(i, i) += weight_(i);
    factor_.factorize(A);
    x_ = factor_.solve_columns(weight_.asDiagonal() * y_);
  }

  /// Logarithm of the likeliest lambda, for this noise; 0: for the likeliest noise.
  [[nodiscard]] double likeliest(double noise) {
    constexpr double kLow = -2, kHigh = 9, kStep = 0.25;
    double best = kLow, least = std::numeric_limits<double>::infinity();
    for (double at = kLow; at <= kHigh; at += kStep) {
      solve(at);
      const double value = unlikeliness(noise);
      if (value >= least) continue;
      least = value;
      best = at;
    }
    return best;
  }

  void hold(std::array<bool, 2> ends) {
    constexpr double kHeld = 1e8;
    if (ends[0]) weight_(0) = kHeld;
    if (ends[1]) weight_(n_ - 1) = kHeld;
  }

  [[nodiscard]] double square() const { return y_.cwiseProduct(y_ - x_).sum(); }
  /// Coordinates that tell the noise.
  [[nodiscard]] int freedom() const { return 2 * (closed_ ? n_ - 1 : n_ - 3); }
  [[nodiscard]] double noise() const { return std::sqrt(square() / freedom()); }
  [[nodiscard]] Eigen::Vector2d point(std::size_t i) const {
    return x_.row(static_cast<Eigen::Index>(i)).transpose();
  }

 private:
  [[nodiscard]] double unlikeliness(double noise) const {
    const double fit = noise > 0 ? square() / (noise * noise) : freedom() * std::log(square());
    return fit + 2 * factor_.pivots().array().log().sum() -
           freedom() * logarithm_ * std::numbers::ln10;
  }

  Eigen::MatrixX2d y_, x_;
  int n_;
  bool closed_;
  LineMatrix D_, DtD_;
  Eigen::VectorXd weight_;
  double logarithm_ = 0;
  SparseLdlt factor_;
};

}  // namespace

FairedLine fair_line(const std::vector<Eigen::Vector2d>& points, bool closed,
                     std::array<bool, 2> hold, double least, double noise) {
  FairedLine faired{points, 0, 0};
  if (points.size() < least_points(noise) || !is_even(points, closed)) return faired;
  SmoothedLine line(points, closed);
  faired.noise = line.tremor();
  if (faired.noise < least) return faired;
  const double logarithm = line.likeliest(noise);
  line.solve(logarithm);
  faired.freedom = line.freedom();
  faired.noise = line.noise();
  if (!closed && (hold[0] || hold[1])) {
    line.hold(hold);
    line.solve(logarithm);
  }
  for (std::size_t i = 0; i < points.size(); ++i) faired.points[i] = line.point(i);
  return faired;
}

FairedView faired_borders(const View& view, double snap) {
  Eigen::AlignedBox2d box;
  std::vector<Eigen::Vector2d> ends;
  for (const Stroke& stroke : view.strokes) {
    if (stroke.kind != StrokeKind::border || stroke.points.empty()) continue;
    for (const Eigen::Vector2d& p : stroke.points) box.extend(p);
    if (stroke.closed) continue;
    ends.push_back(stroke.points.front());
    ends.push_back(stroke.points.back());
  }
  const double diagonal = box.isEmpty() ? 0 : box.diagonal().norm();
  const auto meets = [&](const Eigen::Vector2d& end) {
    // Itself is one of them.
    return std::count_if(ends.begin(), ends.end(), [&](const Eigen::Vector2d& other) {
             return (other - end).norm() <= snap * diagonal;
           }) > 1;
  };
  const auto parts_of = [&](double noise) {
    std::vector<BorderPart> parts;
    for (std::size_t b = 0; b < view.strokes.size(); ++b) {
      const Stroke& stroke = view.strokes[b];
      if (stroke.kind != StrokeKind::border || stroke.points.size() < least_points(noise)) continue;
      const std::vector<std::size_t> cuts = smooth_parts(stroke.points, noise);
      const bool whole = cuts.size() == 2;
      const std::array<bool, 2> met{meets(stroke.points.front()), meets(stroke.points.back())};
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        parts.push_back({b, cuts[k], cuts[k + 1], whole && stroke.closed,
                         whole ? met : std::array<bool, 2>{true, true}});
      }
    }
    return parts;
  };
  const auto fair = [&](const BorderPart& part, double noise) {
    const std::vector<Eigen::Vector2d>& points = view.strokes[part.stroke].points;
    return fair_line({points.begin() + static_cast<std::ptrdiff_t>(part.begin),
                      points.begin() + static_cast<std::ptrdiff_t>(part.end) + 1},
                     part.closed, part.hold, kLeastTremor * diagonal, noise);
  };
  double square = 0;
  int freedom = 0;
  for (const BorderPart& part : parts_of(0)) {
    const FairedLine line = fair(part, 0);
    square += line.freedom * line.noise * line.noise;
    freedom += line.freedom;
  }
  FairedView faired{view, freedom > 0 ? std::sqrt(square / freedom) : 0, diagonal};
  for (const BorderPart& part : parts_of(faired.noise)) {
    const FairedLine line = fair(part, faired.noise);
    std::copy(
        line.points.begin(), line.points.end(),
        faired.view.strokes[part.stroke].points.begin() + static_cast<std::ptrdiff_t>(part.begin));
  }
  return faired;
}

}  // namespace geoprior::sketch
