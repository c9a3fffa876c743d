#include "solvers/sketch/hidden/border_models.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace geoprior::sketch {
namespace {

/// Share of the points that one ruling or end counts as.
constexpr double kHintShare = 0.125;
/// Scales and places from which a copy without rulings is sought.
constexpr std::array<double, 9> kStartScales{0.25, 0.4, 0.6, 0.8, 1, 1.25, 1.6, 2.5, 4};
constexpr int kStartPlaces = 16;
constexpr int kRoughSteps = 5;
constexpr int kCopySteps = 40;
/// Least over greatest eigenvalue of the normal matrix, lengths over the extent of what is seen,
/// below which scale and shift are not told apart.
constexpr double kOpenCopy = 1e-5;

int chords_of(const PictureCurve& curve) {
  return static_cast<int>(curve.points.size()) - (curve.closed ? 0 : 1);
}

const Eigen::Vector2d& point_of(const PictureCurve& curve, int i) {
  return curve.points[static_cast<std::size_t>(i) % curve.points.size()];
}

/// Rows of the linear problem for (scale, shift).
struct CopyRows {
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector2d& direction, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
           double weight) {
    const Eigen::Vector3d row(direction.dot(from), direction.x(), direction.y());
    N += weight * row * row.transpose();
    b += weight * direction.dot(to) * row;
  }
  void add_point(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double weight) {
    add({1, 0}, from, to, weight);
    add({0, 1}, from, to, weight);
  }
};

/// Of the noise: a copy of the original's size that fits worse by less, root mean square, is as
/// good.
constexpr double kSameSize = 1;

/// Fits in a frame in which what is seen has mean 0 and extent 1.
class CopyFit {
 public:
  CopyFit(const PictureCurve& whole, const std::vector<Eigen::Vector2d>& seen,
          const CopyHints& hints)
      : whole_(whole), seen_(seen), hints_(hints) {
    weight_ = kHintShare * static_cast<double>(seen.size());
  }
  [[nodiscard]] std::vector<ParallelCopy> starts() const;
  /// One step; the normal matrix of it.
  Eigen::Matrix3d step(ParallelCopy& copy, bool with_ends, bool same_size = false) const;
  [[nodiscard]] double rms(const ParallelCopy& copy) const;

 private:
  [[nodiscard]] CurvePlace place_of(const ParallelCopy& copy, const Eigen::Vector2d& p) const {
    return nearest_place(whole_, (p - copy.shift) / copy.scale);
  }
  const PictureCurve& whole_;
  const std::vector<Eigen::Vector2d>& seen_;
  const CopyHints& hints_;
  double weight_ = 1;
};

std::vector<ParallelCopy> CopyFit::starts() const {
  const auto& rulings = hints_.rulings;
  if (rulings.size() > 1) {
    CopyRows rows;
    for (const auto& [from, to] : rulings) rows.add_point(from, to, 1);
    const Eigen::Vector3d x = rows.N.ldlt().solve(rows.b);
    if (x.allFinite() && x(0) > 0) return {{x(0), x.tail<2>(), 0}};
  }
  std::vector<ParallelCopy> starts;
  for (const double scale : kStartScales) {
    if (!rulings.empty()) {
      starts.push_back({scale, rulings[0][1] - scale * rulings[0][0], 0});
      continue;
    }
    const Eigen::Vector2d& middle = seen_[seen_.size() / 2];
    for (int k = 0; k < kStartPlaces; ++k) {
      const double at = static_cast<double>(chords_of(whole_)) * (k + 0.5) / kStartPlaces;
      starts.push_back({scale, middle - scale * point_at(whole_, at), 0});
    }
  }
  return starts;
}

Eigen::Matrix3d CopyFit::step(ParallelCopy& copy, bool with_ends, bool same_size) const {
  CopyRows rows;
  for (const Eigen::Vector2d& p : seen_) {
    const CurvePlace place = place_of(copy, p);
    const Eigen::Vector2d from = point_at(whole_, place.at);
    if (place.beyond) {
      rows.add_point(from, p, 1);
      continue;
    }
    const int i = std::min(static_cast<int>(place.at), chords_of(whole_) - 1);
    const Eigen::Vector2d along = (point_of(whole_, i + 1) - point_of(whole_, i)).normalized();
    rows.add({-along.y(), along.x()}, from, p, 1);
  }
  for (const auto& [from, to] : hints_.rulings) rows.add_point(from, to, weight_);
  if (with_ends && !whole_.closed) {
    for (const Eigen::Vector2d& end : hints_.ends) {
      const Eigen::Vector2d &a = whole_.points.front(), &b = whole_.points.back();
      const bool first = (copy(a) - end).norm() < (copy(b) - end).norm();
      rows.add_point(first ? a : b, end, weight_);
    }
  }
  const Eigen::Vector3d before(copy.scale, copy.shift.x(), copy.shift.y());
  // Held where nothing tells: a step keeps what the rows leave open.
  Eigen::Matrix3d N = rows.N;
  const double hold = 1e-9 * N.trace();
  N.diagonal().array() += hold;
  Eigen::Vector3d x = N.ldlt().solve(rows.b + hold * before);
  if (same_size) {
    const Eigen::Vector2d b = (rows.b + hold * before).tail<2>() - N.block<2, 1>(1, 0);
    x << 1, N.bottomRightCorner<2, 2>().ldlt().solve(b);
  }
  if (x.allFinite() && x(0) > 1e-3) copy = {x(0), x.tail<2>(), 0};
  return rows.N;
}

double CopyFit::rms(const ParallelCopy& copy) const {
  double sum = 0;
  for (const Eigen::Vector2d& p : seen_) {
    const double d = copy.scale * place_of(copy, p).distance;
    sum += d * d;
  }
  for (const auto& [from, to] : hints_.rulings) sum += weight_ * (copy(from) - to).squaredNorm();
  return std::sqrt(sum / (static_cast<double>(seen_.size()) +
                          weight_ * static_cast<double>(hints_.rulings.size())));
}

}  // namespace

CurvePlace nearest_place(const PictureCurve& curve, const Eigen::Vector2d& p) {
  CurvePlace best{0, std::numeric_limits<double>::infinity(), false};
  const int chords = chords_of(curve);
  for (int i = 0; i < chords; ++i) {
    const Eigen::Vector2d& a = point_of(curve, i);
    const Eigen::Vector2d d = point_of(curve, i + 1) - a;
    const double square = d.squaredNorm();
    const double raw = square > 0 ? d.dot(p - a) / square : 0;
    const double t = std::clamp(raw, 0.0, 1.0);
    const double distance = (a + t * d - p).norm();
    if (!(distance < best.distance)) continue;
    const bool end = !curve.closed && ((i == 0 && raw < 0) || (i + 1 == chords && raw > 1));
    best = {i + t, distance, end};
  }
  return best;
}

Eigen::Vector2d point_at(const PictureCurve& curve, double at) {
  const int n = static_cast<int>(curve.points.size());
  if (curve.closed) at -= n * std::floor(at / n);
  const int i = std::clamp(static_cast<int>(at), 0, std::max(chords_of(curve) - 1, 0));
  const double t = std::clamp(at - i, 0.0, 1.0);
  return (1 - t) * point_of(curve, i) + t * point_of(curve, i + 1);
}

PictureCurve evenly(const PictureCurve& curve, double spacing) {
  double whole = 0;
  const int chords = chords_of(curve);
  for (int i = 0; i < chords; ++i) whole += (point_of(curve, i + 1) - point_of(curve, i)).norm();
  const int count = std::max(curve.closed ? 8 : 2, static_cast<int>(std::lround(whole / spacing)));
  PictureCurve even{{}, curve.closed};
  int i = 0;
  double before = 0;
  for (int k = 0; k < (curve.closed ? count : count + 1); ++k) {
    const double wanted = whole * k / count;
    double chord = (point_of(curve, i + 1) - point_of(curve, i)).norm();
    while (i + 1 < chords && before + chord < wanted) {
      before += chord;
      ++i;
      chord = (point_of(curve, i + 1) - point_of(curve, i)).norm();
    }
    const double t = chord > 0 ? std::clamp((wanted - before) / chord, 0.0, 1.0) : 0;
    even.points.emplace_back((1 - t) * point_of(curve, i) + t * point_of(curve, i + 1));
  }
  return even;
}

std::optional<ParallelCopy> fit_parallel_copy(const PictureCurve& whole,
                                              const std::vector<Eigen::Vector2d>& seen,
                                              const CopyHints& hints, double noise) {
  if (seen.size() < 3 || whole.points.size() < 3) return {};
  const CopyFit fit(whole, seen, hints);
  std::optional<ParallelCopy> best;
  for (ParallelCopy copy : fit.starts()) {
    for (int k = 0; k < kRoughSteps; ++k) fit.step(copy, false);
    copy.rms = fit.rms(copy);
    if (!best || copy.rms < best->rms) best = copy;
  }
  if (!best) return {};
  Eigen::Matrix3d N;
  for (int k = 0; k < kCopySteps; ++k) N = fit.step(*best, k > kRoughSteps);
  best->rms = fit.rms(*best);
  ParallelCopy same = *best;
  for (int k = 0; k < kCopySteps; ++k) fit.step(same, k > kRoughSteps, true);
  same.rms = fit.rms(same);
  if (std::pow(same.rms, 2) <= std::pow(best->rms, 2) + std::pow(kSameSize * noise, 2)) best = same;
  // Shift of the middle of what is seen, and scale about it: both lengths.
  Eigen::Vector2d mean(0, 0);
  double extent = 0;
  for (const Eigen::Vector2d& p : seen) mean += p / static_cast<double>(seen.size());
  for (const Eigen::Vector2d& p : seen) extent = std::max(extent, (p - mean).norm());
  const Eigen::Vector2d about = (mean - best->shift) / best->scale;
  Eigen::Matrix3d to = Eigen::Matrix3d::Identity();
  to(0, 0) = best->scale / extent;
  to.block<2, 1>(1, 0) = -about * to(0, 0);
  const Eigen::Matrix3d M = to.transpose() * N * to;
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(M).eigenvalues();
  if (!(values(0) > kOpenCopy * values(2))) return {};
  return best;
}

Eigen::Vector2d PictureMirror::operator()(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d v(-u.y(), u.x());
  return p + (offset - 2 * u.dot(p) + slope * v.dot(p)) * u;
}

std::optional<PictureMirror> fit_picture_mirror(const Eigen::Vector2d& u,
                                                const std::vector<Eigen::Vector2d>& middles,
                                                double least_apart) {
  const Eigen::Vector2d v(-u.y(), u.x());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b(0, 0);
  for (const Eigen::Vector2d& m : middles) {
    const Eigen::Vector2d row(1, v.dot(m));
    low = std::min(low, row.y());
    high = std::max(high, row.y());
    N += row * row.transpose();
    b += 2 * u.dot(m) * row;
  }
  if (!(high - low >= least_apart)) return {};
  const Eigen::Vector2d x = N.ldlt().solve(b);
  return PictureMirror{u, x.x(), x.y()};
}

}  // namespace geoprior::sketch
