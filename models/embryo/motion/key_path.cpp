#include "models/embryo/motion/key_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

/// Parameter of a span at which the arc has come to a fraction of the whole curve; Newton's steps,
/// halved where they leave the bracket, down to round-off.
double parameter_at(const Curve& curve, int span, double fraction) {
  double low = 0, high = 1;
  const double begin = curve.fraction_at(span, 0), end = curve.fraction_at(span, 1);
  double t = end > begin ? std::clamp((fraction - begin) / (end - begin), 0.0, 1.0) : 0;
  for (int step = 0; step < 60; ++step) {
    const double error = curve.fraction_at(span, t) - fraction;
    (error > 0 ? high : low) = t;
    const double speed = curve.spans()[span].derivative(t).norm() / curve.length();
    double next = t - error / speed;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    const bool reached = std::abs(next - t) <= 1e-16 || next == t;
    t = next;
    if (reached || std::abs(error) <= 1e-17) break;
  }
  return t;
}

/// Cosine of the turn at a key, from the places before and after it that are others; at most 1, 0
/// where it is a right angle or more.
double straightness(std::span<const Eigen::Vector3d> places, int key) {
  int before = key - 1, after = key + 1;
  const int n = static_cast<int>(places.size());
  while (before >= 0 && places[before] == places[key]) --before;
  while (after < n && places[after] == places[key]) ++after;
  if (before < 0 || after >= n) return 0;
  const Eigen::Vector3d in = (places[key] - places[before]).normalized(),
                        out = (places[after] - places[key]).normalized();
  return std::clamp(in.dot(out), 0.0, 1.0);
}

}  // namespace

KeyPath::KeyPath(std::vector<double> days, std::vector<Eigen::Vector3d> places,
                 Interpolation interpolation)
    : places_(std::move(places)), interpolation_(interpolation) {
  const int n = static_cast<int>(places_.size());
  if (interpolation == Interpolation::linear) {
    Eigen::MatrixXd values(n, 3);
    for (int i = 0; i < n; ++i) values.row(i) = places_[i].transpose();
    pace_ = MonotoneCurve(std::move(days), std::move(values), interpolation, Ends::rest);
    return;
  }
  curve_.emplace(std::span<const Eigen::Vector3d>(places_));
  Eigen::MatrixXd arc = Eigen::MatrixXd::Zero(n, 1);
  int span = 0;
  for (int i = 1; i < n; ++i) {
    const bool stays = places_[i] == places_[i - 1];
    span_.push_back(stays ? -1 : span);
    arc(i, 0) = stays ? arc(i - 1, 0) : curve_->fraction_at(span++, 1);
  }
  pace_ = MonotoneCurve(std::move(days), std::move(arc), interpolation, Ends::rest);
  for (int i = 0; i < n; ++i) pace_.damp(i, straightness(places_, i));
}

Eigen::Vector3d KeyPath::at(double day) const {
  if (interpolation_ == Interpolation::linear) return pace_.at(day);
  if (day <= pace_.days().front()) return places_.front();
  if (day >= pace_.days().back()) return places_.back();
  const int i = pace_.interval(day);
  if (span_[i] < 0 || day == pace_.days()[i]) return places_[i];
  const double t = parameter_at(*curve_, span_[i], pace_.at(day)[0]);
  return curve_->spans()[span_[i]].at(t);
}

}  // namespace geoprior::embryo
