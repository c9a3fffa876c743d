#include "metrics/isometry/circular_arc.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

/// Sine of the turn at the middle point, below which three points lie on a line.
constexpr double kStraightSine = 1e-9;

CircularArc straight_chain(const Eigen::MatrixX3d& points) {
  CircularArc arc;
  arc.radius = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d a = points.row(0).transpose();
  const Eigen::Vector3d along = points.row(points.rows() - 1).transpose() - a;
  arc.length = along.norm();
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    arc.off = std::max(arc.off, (points.row(i).transpose() - a).cross(along).norm() / arc.length);
  return arc;
}

}  // namespace

CircularArc circular_arc(const Eigen::MatrixX3d& points) {
  const Eigen::Index n = points.rows();
  if (n < 3)
    throw Error("an arc of " + std::to_string(n) + " points", "circular arc", "three or more");
  const Eigen::Vector3d a = points.row(0).transpose();
  const Eigen::Vector3d u = points.row(n / 2).transpose() - a,
                        w = points.row(n - 1).transpose() - a;
  const double uu = u.squaredNorm(), ww = w.squaredNorm();
  if (!(uu > 0) || !(ww > 0) || !((w - u).squaredNorm() > 0))
    throw Error("first, middle and last point are not distinct", "circular arc", "an open chain");
  const Eigen::Vector3d c = u.cross(w);
  if (c.norm() <= kStraightSine * std::sqrt(uu * ww)) return straight_chain(points);

  CircularArc arc;
  const Eigen::Vector3d from_a = (uu * w - ww * u).cross(c) / (2 * c.squaredNorm());
  arc.centre = a + from_a;
  arc.radius = from_a.norm();
  arc.axis = c.normalized();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d d = points.row(i).transpose() - arc.centre;
    const double height = d.dot(arc.axis);
    arc.off = std::max(arc.off, std::hypot(height, (d - height * arc.axis).norm() - arc.radius));
    if (i == 0) continue;
    const Eigen::Vector3d before = points.row(i - 1).transpose() - arc.centre;
    arc.angle += std::atan2(before.cross(d).dot(arc.axis), before.dot(d));
  }
  arc.length = arc.radius * arc.angle;
  return arc;
}

ArcDifference arc_difference(const CircularArc& arc, const CircularArc& truth) {
  return {std::abs(arc.radius / truth.radius - 1),
          std::atan2(arc.axis.cross(truth.axis).norm(), std::abs(arc.axis.dot(truth.axis)))};
}

}  // namespace geoprior
