#include "models/grammar/maps/strokes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/limits.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Longest step of a tool in radii.
constexpr double kToolStep = 0.2;
/// Largest logarithmic strain of a dab that inflates.
constexpr double kStrainStep = 0.4;
/// Largest angle of a dab that bends (rad).
constexpr double kBendStep = 0.3;
constexpr double kMostDabs = 100000;

/// Where s w(s) is largest: (3 + sqrt 105) / 48.
constexpr double kBendPeak = 0.27597814095749165;
constexpr double kBendScale = 1 / (kBendPeak * falloff(kBendPeak));

double path_length(const Stroke& stroke) {
  double length = 0;
  for (std::size_t i = 1; i < stroke.path.size(); ++i)
    length += (stroke.path[i] - stroke.path[i - 1]).norm();
  return length;
}

/// Where the tool is after a length of its path (m).
Vector3d tool_after(const std::vector<Vector3d>& path, double length) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double step = (path[i] - path[i - 1]).norm();
    if (length < step) return path[i - 1] + length / step * (path[i] - path[i - 1]);
    length -= step;
  }
  return path.back();
}

/// Number of dabs that a stroke takes, in floating point so that no number is too large for it.
double dabs_needed(const Stroke& stroke) {
  const double steps = std::ceil(path_length(stroke) / (kToolStep * stroke.radius));
  switch (stroke.kind) {
    case Stroke::Kind::grab:
      return steps;
    case Stroke::Kind::inflate:
      return std::max({1.0, steps, std::ceil(std::abs(std::log1p(stroke.amount)) / kStrainStep)});
    case Stroke::Kind::twist:
      return std::max(1.0, steps);
    case Stroke::Kind::bend:
      return std::max({1.0, steps, std::ceil(std::abs(stroke.amount) / kBendStep)});
  }
  return 0;
}

/// What one of `count` dabs has of the stroke's amount.
double dab_amount(const Stroke& stroke, int count) {
  switch (stroke.kind) {
    case Stroke::Kind::grab:
      return 0;
    case Stroke::Kind::inflate:
      return std::expm1(std::log1p(stroke.amount) / count);
    case Stroke::Kind::twist:
    case Stroke::Kind::bend:
      break;
  }
  return stroke.amount / count;
}

/// Sine and cosine of half an angle. Of small ones, which most are, by Taylor's series to x^11 and
/// x^12, whose rests are below 3e-18: faster than the library's.
std::array<double, 2> half_angle(double angle) {
  const double x = angle / 2, y = x * x;
  if (!(y < 0.0625)) return {std::sin(x), std::cos(x)};
  double sine = -1 / 39916800.0, cosine = 1 / 479001600.0;
  for (const double c : {1 / 362880.0, -1 / 5040.0, 1 / 120.0, -1 / 6.0, 1.0}) sine = c + y * sine;
  for (const double c : {-1 / 3628800.0, 1 / 40320.0, -1 / 720.0, 1 / 24.0, -0.5, 1.0})
    cosine = c + y * cosine;
  return {x * sine, cosine};
}

/// The turn r -> R(axis, angle) r of a point whose angle is its own. As a shift it rounds to
/// nothing at the rim; sin and 1 - cos from half the angle lose no digits there.
class TurnInBall {
 public:
  TurnInBall(const Vector3d& axis, double angle, const Vector3d& r)
      : axis_(axis), across_(axis.cross(r)), inward_(axis.cross(across_)) {
    const auto [half_sin, half_cos] = half_angle(angle);
    sine_ = 2 * half_sin * half_cos;
    versine_ = 2 * half_sin * half_sin;
  }
  [[nodiscard]] Vector3d shift() const { return sine_ * across_ + versine_ * inward_; }
  /// R + (axis x R r) (grad angle)^T
  [[nodiscard]] Matrix3d derivative(const Vector3d& angle_gradient) const {
    Matrix3d D = (versine_ * axis_) * axis_.transpose();
    D.diagonal().array() += 1 - versine_;
    const Vector3d s = sine_ * axis_;
    D(0, 1) -= s.z(), D(0, 2) += s.y(), D(1, 0) += s.z();
    D(1, 2) -= s.x(), D(2, 0) -= s.y(), D(2, 1) += s.x();
    D += ((1 - versine_) * across_ + sine_ * inward_) * angle_gradient.transpose();
    return D;
  }

 private:
  Vector3d axis_, across_, inward_;
  double sine_, versine_;
};

/// Moves a point that is in the ball of a dab, and the derivative so far where it is asked for.
template <bool kDerivative>
void move_in_ball(const Dab& dab, double squared_distance, Vector3d& x, Matrix3d& J) {
  const Vector3d r = x - dab.centre;
  const double s = std::sqrt(squared_distance) / dab.radius, rest = 1 - s;
  const double w = falloff(s);
  const Vector3d gradient = (-20 * rest * rest * rest / (dab.radius * dab.radius)) * r;
  switch (dab.kind) {
    case Stroke::Kind::grab:
      x += w * dab.shift;
      if constexpr (kDerivative) J += dab.shift * (gradient.transpose() * J).eval();
      break;
    case Stroke::Kind::inflate:
      x += (dab.amount * w) * r;
      if constexpr (kDerivative)
        J = (1 + dab.amount * w) * J + dab.amount * r * (gradient.transpose() * J).eval();
      break;
    case Stroke::Kind::twist: {
      const TurnInBall turn(dab.axis, dab.amount * w, r);
      x += turn.shift();
      if constexpr (kDerivative) J = (turn.derivative(dab.amount * gradient) * J).eval();
      break;
    }
    case Stroke::Kind::bend: {
      const double scale = kBendScale * dab.amount, u = r.dot(dab.along) / dab.radius;
      const TurnInBall turn(dab.axis, scale * u * w, r);
      x += turn.shift();
      if constexpr (kDerivative) {
        const Vector3d slope = (scale * w / dab.radius) * dab.along + (scale * u) * gradient;
        J = (turn.derivative(slope) * J).eval();
      }
      break;
    }
  }
}

/// A dab whose ball the point, as it is moved by now, is not in costs its squared distance.
template <bool kDerivative>
void move_by_dabs(const std::vector<Dab>& dabs, Vector3d& x, Matrix3d& J) {
  for (const Dab& dab : dabs) {
    const double squared_distance = (x - dab.centre).squaredNorm();
    if (squared_distance < dab.radius * dab.radius)
      move_in_ball<kDerivative>(dab, squared_distance, x, J);
  }
}

void require_directions(const Stroke& stroke, const std::string& where) {
  const bool bends = stroke.kind == Stroke::Kind::bend;
  if (!bends && stroke.kind != Stroke::Kind::twist) return;
  if (!(stroke.axis.norm() > 0)) throw Error("has an axis without direction", where);
  if (bends &&
      !(stroke.axis.cross(stroke.along).norm() > 1e-6 * stroke.axis.norm() * stroke.along.norm()))
    throw Error("bends along its own axis", where, "'along' in another direction than 'axis'");
}

}  // namespace

void require_valid(const Stroke& stroke, const std::string& where) {
  const std::size_t least = stroke.kind == Stroke::Kind::grab ? 2 : 1;
  if (stroke.path.size() < least)
    throw Error("has a path of " + std::to_string(stroke.path.size()) + " points", where,
                least == 2 ? "two or more: a grab moves" : "one or more");
  bool finite = std::isfinite(stroke.amount) && stroke.axis.allFinite() && stroke.along.allFinite();
  for (const Vector3d& x : stroke.path) finite = finite && x.allFinite();
  if (!finite) throw Error("has a number that is not finite", where, "finite numbers");
  if (!(stroke.radius > 0) || !std::isfinite(stroke.radius))
    throw Error("has the radius " + std::to_string(stroke.radius) + " m", where, "above 0");
  if (stroke.kind == Stroke::Kind::inflate && !(stroke.amount > -1))
    throw Error("inflates by a strain of " + std::to_string(stroke.amount), where, "above -1");
  require_directions(stroke, where);
  require_count(dabs_needed(stroke), "dabs of a stroke", kMostDabs, where);
}

void append_dabs(const Stroke& stroke, double fraction, std::vector<Dab>& out) {
  const int count = static_cast<int>(dabs_needed(stroke));
  const double length = path_length(stroke);
  const bool grabs = stroke.kind == Stroke::Kind::grab;
  Dab dab;
  dab.kind = stroke.kind;
  dab.radius = stroke.radius;
  const bool turns = stroke.kind == Stroke::Kind::twist || stroke.kind == Stroke::Kind::bend;
  if (turns) dab.axis = stroke.axis.normalized();
  if (stroke.kind == Stroke::Kind::bend)
    dab.along = (stroke.along - stroke.along.dot(dab.axis) * dab.axis).normalized();
  for (int i = 0; i < count; ++i) {
    const double part = std::clamp(fraction * count - i, 0.0, 1.0);
    if (part == 0) break;
    dab.centre = tool_after(stroke.path, length * (grabs ? i : i + 0.5) / count);
    if (grabs) {
      const Vector3d end =
          i + 1 == count ? stroke.path.back() : tool_after(stroke.path, length * (i + 1) / count);
      dab.shift = part * (end - dab.centre);
    }
    dab.amount = part * dab_amount(stroke, count);
    out.push_back(dab);
  }
}

/// A point that rounding puts into a ball from just outside of its box must be in the box.
StrokeMap::StrokeMap(std::vector<Dab> dabs) : dabs_(std::move(dabs)) {
  for (const Dab& dab : dabs_) {
    const double reach = dab.radius + 1e-12 * (dab.radius + dab.centre.cwiseAbs().maxCoeff());
    support_.extend((dab.centre.array() - reach).matrix());
    support_.extend((dab.centre.array() + reach).matrix());
  }
}

Vector3d StrokeMap::at(const Vector3d& x) const {
  Vector3d y = x;
  Matrix3d unused;
  move_by_dabs<false>(dabs_, y, unused);
  return y;
}

MappedPoint StrokeMap::with_jacobian(const Vector3d& x) const {
  MappedPoint out{x, Matrix3d::Identity()};
  move_by_dabs<true>(dabs_, out.position, out.jacobian);
  return out;
}

}  // namespace geoprior::grammar
