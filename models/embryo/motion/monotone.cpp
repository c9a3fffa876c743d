#include "models/embryo/motion/monotone.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

double inner_slope(double h0, double h1, double d0, double d1) {
  if (d0 * d1 <= 0) return 0;
  const double w0 = h0 + 2 * h1, w1 = 2 * h0 + h1;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

/// At the end of the interval (h0, d0), whose neighbour is (h1, d1).
double end_slope(double h0, double h1, double d0, double d1) {
  const double slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  return d0 * d1 <= 0 && std::abs(slope) > 3 * std::abs(d0) ? 3 * d0 : slope;
}

void require_keys(const std::vector<double>& days, const Eigen::MatrixXd& values) {
  if (days.empty() || values.rows() != static_cast<Eigen::Index>(days.size()))
    throw Error(std::to_string(values.rows()) + " rows of values at " +
                    std::to_string(days.size()) + " days",
                "curve over days", "as many of both, one or more");
  for (std::size_t i = 0; i < days.size(); ++i) {
    if (!std::isfinite(days[i]) || !values.row(static_cast<Eigen::Index>(i)).allFinite())
      throw Error("a number is not finite", "key " + std::to_string(i));
    if (i > 0 && !(days[i - 1] < days[i]))
      throw Error("days do not ascend", "key " + std::to_string(i));
  }
}

}  // namespace

MonotoneCurve::MonotoneCurve(std::vector<double> days, Eigen::MatrixXd values,
                             Interpolation interpolation, Ends ends)
    : days_(std::move(days)), values_(std::move(values)), interpolation_(interpolation) {
  require_keys(days_, values_);
  const Eigen::Index n = values_.rows();
  slopes_ = Eigen::MatrixXd::Zero(n, values_.cols());
  if (n < 2 || interpolation == Interpolation::linear) return;
  const auto step = [&](Eigen::Index i) { return days_[i + 1] - days_[i]; };
  for (Eigen::Index c = 0; c < values_.cols(); ++c) {
    const auto secant = [&](Eigen::Index i) {
      return (values_(i + 1, c) - values_(i, c)) / step(i);
    };
    for (Eigen::Index i = 1; i + 1 < n; ++i)
      slopes_(i, c) = inner_slope(step(i - 1), step(i), secant(i - 1), secant(i));
    if (ends == Ends::rest) continue;
    if (n == 2) {
      slopes_.col(c).setConstant(secant(0));
      continue;
    }
    slopes_(0, c) = end_slope(step(0), step(1), secant(0), secant(1));
    slopes_(n - 1, c) = end_slope(step(n - 2), step(n - 3), secant(n - 2), secant(n - 3));
  }
}

int MonotoneCurve::interval(double day) const {
  if (days_.size() < 2) return 0;
  const auto above = std::upper_bound(days_.begin() + 1, days_.end() - 1, day);
  return static_cast<int>(above - days_.begin()) - 1;
}

Eigen::VectorXd MonotoneCurve::beyond(double day) const {
  const bool before = day <= days_.front();
  const Eigen::Index end = before ? 0 : values_.rows() - 1;
  if (values_.rows() < 2 || interpolation_ == Interpolation::linear)
    return values_.row(end).transpose();
  const double h = before ? days_[1] - days_[0] : days_[end] - days_[end - 1];
  const double distance = std::abs(day - days_[end]);
  const double way = -h * std::expm1(-distance / h);
  return (values_.row(end) + (before ? -way : way) * slopes_.row(end)).transpose();
}

Eigen::VectorXd MonotoneCurve::at(double day) const {
  if (day <= days_.front() || day >= days_.back()) return beyond(day);
  const int i = interval(day);
  const double h = days_[i + 1] - days_[i], u = (day - days_[i]) / h;
  const auto rise = values_.row(i + 1) - values_.row(i);
  if (interpolation_ == Interpolation::linear) return (values_.row(i) + u * rise).transpose();
  const double done = u * u * (3 - 2 * u), first = h * u * (1 - u) * (1 - u),
               second = -h * u * u * (1 - u);
  return (values_.row(i) + done * rise + first * slopes_.row(i) + second * slopes_.row(i + 1))
      .transpose();
}

}  // namespace geoprior::embryo
