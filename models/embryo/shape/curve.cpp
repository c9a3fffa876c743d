#include "models/embryo/shape/curve.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

constexpr int kPieces = 8;  ///< of a span, whose arcs are tabulated

/// Length of the arc between two parameters of a span, by Gauss and Legendre's five points.
double gauss_arc(const CubicSpan& span, double from, double to) {
  constexpr std::array<double, 3> kNode = {0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> kWeight = {0.5688888888888889, 0.4786286704993665,
                                             0.2369268850561891};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = kWeight[0] * span.derivative(middle).norm();
  for (int i = 1; i < 3; ++i)
    sum += kWeight[i] * (span.derivative(middle - half * kNode[i]).norm() +
                         span.derivative(middle + half * kNode[i]).norm());
  return half * sum;
}

/// The span from b to c; a and d are the control points beside it.
CubicSpan catmull_rom(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const double before = std::sqrt((b - a).norm()), own = std::sqrt((c - b).norm()),
               after = std::sqrt((d - c).norm());
  const Vector3d m_b = (c - b) + own * ((b - a) / before - (c - a) / (before + own));
  const Vector3d m_c = (c - b) + own * ((d - c) / after - (d - b) / (own + after));
  return {{b, m_b, 3 * (c - b) - 2 * m_b - m_c, 2 * (b - c) + m_b + m_c}};
}

std::vector<Vector3d> distinct_points(std::span<const Vector3d> points) {
  if (points.empty()) throw Error("a curve without control points", "", "one or more");
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw Error("coordinate is not finite", "control point " + std::to_string(i),
                  "finite numbers");
    if (out.empty() || points[i] != out.back()) out.push_back(points[i]);
  }
  return out;
}

}  // namespace

Curve::Curve(std::span<const Vector3d> points) : arc_{0.0} {
  const std::vector<Vector3d> P = distinct_points(points);
  first_ = P.front();
  const int n = static_cast<int>(P.size());
  for (int i = 0; i + 1 < n; ++i) {
    const Vector3d before = i > 0 ? P[i - 1] : Vector3d(2 * P[i] - P[i + 1]);
    const Vector3d after = i + 2 < n ? P[i + 2] : Vector3d(2 * P[i + 1] - P[i]);
    spans_.push_back(catmull_rom(before, P[i], P[i + 1], after));
    for (int k = 0; k < kPieces; ++k)
      arc_.push_back(arc_.back() +
                     gauss_arc(spans_.back(), double(k) / kPieces, double(k + 1) / kPieces));
  }
}

double Curve::arc_at(int span, double t) const {
  const int piece = std::clamp(static_cast<int>(t * kPieces), 0, kPieces - 1);
  return arc_[span * kPieces + piece] + gauss_arc(spans_[span], double(piece) / kPieces, t);
}

double Curve::fraction_at(int span, double t) const {
  return length() > 0 ? arc_at(span, t) / length() : 0;
}

Vector3d Curve::at_fraction(double fraction) const {
  if (spans_.empty()) return first_;
  const double target = std::clamp(fraction, 0.0, 1.0) * length();
  const auto above = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, target);
  const int piece = static_cast<int>(above - arc_.begin()) - 1;
  const CubicSpan& span = spans_[piece / kPieces];
  const double low = double(piece % kPieces) / kPieces, high = low + 1.0 / kPieces;
  const double whole = arc_[piece + 1] - arc_[piece];
  double t = whole > 0 ? low + (target - arc_[piece]) / whole / kPieces : low;
  for (int step = 0; step < 4; ++step) {
    const double speed = span.derivative(t).norm();
    if (!(speed > 0)) break;
    t = std::clamp(t + (target - arc_[piece] - gauss_arc(span, low, t)) / speed, low, high);
  }
  return span.at(t);
}

std::vector<Vector3d> Curve::polyline(int per_span) const {
  if (per_span < 1) throw Error("a poly-line of no pieces", "", "1 or more a span");
  std::vector<Vector3d> out = {first_};
  for (const CubicSpan& span : spans_)
    for (int k = 1; k <= per_span; ++k) out.push_back(span.at(double(k) / per_span));
  return out;
}

}  // namespace geoprior::embryo
