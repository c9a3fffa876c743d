#include "testbed/formats/svg/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/geometry/planar.h"

namespace geoprior {
namespace {

constexpr int kMostChords = 4096;

/// Centre of the arc in coordinates where the ellipse is a unit circle (F.6.5 after scaling).
Eigen::Vector2d unit_circle_centre(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                   bool far_side) {
  const Eigen::Vector2d half = (to - from) / 2;
  const double squared = std::max(half.squaredNorm(), std::numeric_limits<double>::min());
  const double height = std::sqrt(std::max(0.0, 1 / squared - 1));
  const Eigen::Vector2d normal(-half.y(), half.x());
  return (from + to) / 2 + (far_side ? height : -height) * normal;
}

}  // namespace

void flatten_cubic(const Eigen::Vector2d& p0, const Eigen::Vector2d& p1, const Eigen::Vector2d& p2,
                   const Eigen::Vector2d& p3, double tolerance, std::vector<Eigen::Vector2d>& out) {
  // A chord over a parameter interval h is off by at most h^2 max|p''| / 8.
  const double second = 6 * std::max((p0 - 2 * p1 + p2).norm(), (p1 - 2 * p2 + p3).norm());
  const double wanted = std::ceil(std::sqrt(second / (8 * tolerance)));
  const int n = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMostChords)));
  for (int i = 1; i < n; ++i) {
    const double t = static_cast<double>(i) / n, s = 1 - t;
    out.push_back(s * s * s * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3);
  }
  out.push_back(p3);
}

void flatten_arc(const SvgArc& arc, double tolerance, std::vector<Eigen::Vector2d>& out) {
  if (arc.from == arc.to) return;
  Eigen::Vector2d radii = arc.radii.cwiseAbs();
  if (radii.minCoeff() == 0) {
    out.push_back(arc.to);
    return;
  }
  const double turn = arc.turn_deg * std::numbers::pi / 180;
  Eigen::Matrix2d rotation;
  rotation << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  const auto to_circle = [&](const Eigen::Vector2d& p) -> Eigen::Vector2d {
    return (rotation.transpose() * p).cwiseQuotient(radii);
  };
  const double reach = (to_circle(arc.to) - to_circle(arc.from)).norm() / 2;
  constexpr double kFarthest = 1e12;  // in radii; the rest of the number is noise beyond it
  if (!(reach < kFarthest)) {
    out.push_back(arc.to);
    return;
  }
  if (reach > 1) radii *= reach;
  const Eigen::Vector2d from = to_circle(arc.from), to = to_circle(arc.to);
  const Eigen::Vector2d centre = unit_circle_centre(from, to, arc.large != arc.sweep);
  const double first = std::atan2(from.y() - centre.y(), from.x() - centre.x());
  double span = signed_angle(from - centre, to - centre);
  if (arc.sweep && span < 0) span += 2 * std::numbers::pi;
  if (!arc.sweep && span > 0) span -= 2 * std::numbers::pi;
  // A chord over an angle a is off by at most r (1 - cos(a / 2)).
  const double largest = radii.maxCoeff();
  const double step = 2 * std::acos(std::clamp(1 - tolerance / largest, 0.0, 1.0));
  const double wanted = step > 0 ? std::ceil(std::abs(span) / step) : kMostChords;
  const int n = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(kMostChords)));
  for (int i = 1; i < n; ++i) {
    const double angle = first + span * i / n;
    const Eigen::Vector2d p = centre + Eigen::Vector2d(std::cos(angle), std::sin(angle));
    out.push_back(rotation * p.cwiseProduct(radii));
  }
  out.push_back(arc.to);
}

}  // namespace geoprior
