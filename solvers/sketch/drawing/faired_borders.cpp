#include "solvers/sketch/drawing/faired_borders.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "core/numerics/sparse_ldlt.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kLeastPoints = 12;
/// Chord that nineteen of twenty are shorter than, over the median.
constexpr double kUneven = 3.5;
/// Of the estimated noise: by which points are moved.
constexpr double kMoved = 0.92;
/// Of the borders' diagonal: below it nothing trembles.
constexpr double kLeastTremor = 2e-4;
constexpr double kFairCorner = 60 * kDegree;
constexpr int kCornerPoints = 5;

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

/// Numbers of points between which a line has no corner, first and last of them included.
std::vector<std::size_t> smooth_parts(const std::vector<Eigen::Vector2d>& points) {
  const std::size_t n = points.size();
  std::vector<std::size_t> cuts{0};
  double sharpest = 0;
  std::size_t corner = 0;
  for (std::size_t i = kCornerPoints; i + kCornerPoints < n; ++i) {
    const double turn = std::abs(
        signed_angle(points[i] - points[i - kCornerPoints], points[i + kCornerPoints] - points[i]));
    if (turn > kFairCorner && turn > sharpest) {
      sharpest = turn;
      corner = i;
    }
    // The sharpest of neighbours.
    if (corner > 0 && i >= corner + kCornerPoints) {
      cuts.push_back(corner);
      corner = 0;
      sharpest = 0;
    }
  }
  if (corner > 0) cuts.push_back(corner);
  cuts.push_back(n - 1);
  return cuts;
}

}  // namespace

FairedLine fair_line(const std::vector<Eigen::Vector2d>& points, bool closed,
                     std::array<bool, 2> hold, double least) {
  FairedLine faired{points, 0};
  if (points.size() < kLeastPoints || !is_even(points, closed)) return faired;
  const int n = static_cast<int>(points.size());
  Eigen::MatrixX2d y(n, 2);
  for (int i = 0; i < n; ++i) y.row(i) = points[static_cast<std::size_t>(i)].transpose();
  const LineMatrix D = third_differences(n, closed);
  const Eigen::MatrixX2d third = D * y;
  std::vector<double> sizes;
  for (Eigen::Index r = 0; r < third.rows(); ++r)
    for (int k = 0; k < 2; ++k) sizes.push_back(std::abs(third(r, k)));
  faired.noise = median_of(std::move(sizes)) / (0.6745 * std::sqrt(20.0));
  if (faired.noise < least) return faired;
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(n);
  constexpr double kHeld = 1e8;
  if (!closed && hold[0]) weight(0) = kHeld;
  if (!closed && hold[1]) weight(n - 1) = kHeld;
  const LineMatrix DtD = D.transpose() * D;
  Eigen::MatrixX2d x = y;
  double low = -4, high = 10;  // of log10 lambda
  constexpr int kHalvings = 24;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    LineMatrix A = std::pow(10.0, middle) * DtD;
    for (int i = 0; i < n; ++i) A.coeffRef(i, i) += weight(i);
    const SparseLdlt factor(A);
    for (int c = 0; c < 2; ++c) x.col(c) = factor.solve(weight.cwiseProduct(y.col(c)));
    const double moved = std::sqrt((x - y).squaredNorm() / (2.0 * n));
    (moved < kMoved * faired.noise ? low : high) = middle;
  }
  for (int i = 0; i < n; ++i) faired.points[static_cast<std::size_t>(i)] = x.row(i).transpose();
  return faired;
}

View faired_borders(const View& view, double snap) {
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
  View faired = view;
  for (Stroke& stroke : faired.strokes) {
    if (stroke.kind != StrokeKind::border || stroke.points.size() < kLeastPoints) continue;
    const std::vector<std::size_t> cuts = smooth_parts(stroke.points);
    if (cuts.size() == 2) {
      stroke.points = fair_line(stroke.points, stroke.closed,
                                {meets(stroke.points.front()), meets(stroke.points.back())},
                                kLeastTremor * diagonal)
                          .points;
      continue;
    }
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const auto begin = stroke.points.begin() + static_cast<std::ptrdiff_t>(cuts[k]);
      const auto end = stroke.points.begin() + static_cast<std::ptrdiff_t>(cuts[k + 1]) + 1;
      const FairedLine part = fair_line({begin, end}, false, {true, true}, kLeastTremor * diagonal);
      std::copy(part.points.begin(), part.points.end(), begin);
    }
  }
  return faired;
}

}  // namespace geoprior::sketch
