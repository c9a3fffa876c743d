#include "metrics/isometry/elastica.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/error.h"

namespace geoprior {
namespace {

/// Convergence is quadratic: this many steps reach round-off for every modulus below 1.
constexpr int kAgmSteps = 10;

}  // namespace

EllipticIntegrals elliptic_integrals(double modulus) {
  if (!(modulus >= 0 && modulus < 1)) {
    throw Error("modulus " + std::to_string(modulus), "elliptic integral", "0 <= k < 1");
  }
  double a = 1;
  double b = std::sqrt((1 - modulus) * (1 + modulus));
  double power = 0.5;  // 2^(n - 1)
  double sum = power * modulus * modulus;
  for (int n = 0; n < kAgmSteps; ++n) {
    const double c = (a - b) / 2;
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
    power *= 2;
    sum += power * c * c;
  }
  const double first = std::numbers::pi / (2 * a);
  return {first, first * (1 - sum)};
}

double elastica_height(double length, double distance) {
  if (!(length > 0) || !(distance >= 0) || !(distance <= length)) {
    throw Error("ends " + std::to_string(distance) + " m apart on a strip of " +
                    std::to_string(length) + " m",
                "elastica", "a positive length and 0 … length");
  }
  // 2 E / K - 1 falls from 1 to -1 as k goes from 0 to 1; 0, ends that touch, is at k = 0.909.
  double low = 0;
  double high = 0.95;
  for (int i = 0; i < 60; ++i) {
    const double k = (low + high) / 2;
    const EllipticIntegrals integrals = elliptic_integrals(k);
    const bool too_straight = 2 * integrals.second / integrals.first - 1 > distance / length;
    (too_straight ? low : high) = k;
  }
  const double k = (low + high) / 2;
  return length * k / elliptic_integrals(k).first;
}

Eigen::Vector2d Strip::at(double s, double t) const {
  const Eigen::Vector2d a = (1 - s) * first[0] + s * first[1];
  const Eigen::Vector2d b = (1 - s) * second[0] + s * second[1];
  return (1 - t) * a + t * b;
}

double Strip::length() const { return (at(0.5, 1) - at(0.5, 0)).norm(); }

std::optional<Strip> strip_between(const Strip::Side& first, const Strip::Side& second,
                                   double area) {
  Strip strip{first, second};
  const Eigen::Vector2d side = first[1] - first[0];
  if (side.dot(second[1] - second[0]) < 0) std::swap(strip.second[0], strip.second[1]);
  // Equal parallel sides, their distance along the normal, and nothing beyond them.
  const double tolerance = 1e-6 * side.norm();
  const Eigen::Vector2d across = strip.second[0] - strip.first[0];
  const bool rectangle = (strip.second[1] - strip.second[0] - side).norm() < tolerance &&
                         std::abs(across.dot(side.normalized())) < tolerance;
  const double between = side.norm() * across.norm();
  if (!rectangle || std::abs(area - between) > 1e-6 * between) return std::nullopt;
  return strip;
}

StripRise strip_rise(std::span<const BentLine> lines) {
  StripRise mean;
  const auto count = static_cast<double>(lines.size());
  for (const BentLine& line : lines) {
    const Eigen::Vector3d chord = line.end - line.start;
    const Eigen::Vector3d rise = line.middle - line.start;
    mean.distance += chord.norm() / count;
    mean.height += rise.cross(chord).norm() / chord.norm() / count;
  }
  return mean;
}

}  // namespace geoprior
