#include "solvers/sketch/drawing/mirror_plane.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

/// Sine below which two drawn vectors are parallel, and foreshortening (depth over length) below
/// which both lie in the picture's plane: half a degree, finer than a hand draws.
constexpr double kFlatSine = 0.01;

struct VectorDepths {
  double a = 0;
  double b = 0;
};

Eigen::Vector2d drawn_vector(const Stroke& stroke) {
  const Eigen::Vector2d v = stroke.points.size() < 2
                                ? Eigen::Vector2d(0, 0)
                                : Eigen::Vector2d(stroke.points.back() - stroke.points.front());
  if (!(v.norm() > 0)) {
    throw Error("vector of the mirror plane has no length", "stroke '" + stroke.id + "'",
                "two different points");
  }
  return v;
}

/// Depths of the heads, up to their common sign; a's is not negative, nor b's where a's is zero.
VectorDepths depths_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double c = a.dot(b);
  const double d = b.squaredNorm() - a.squaredNorm();
  const double root = std::hypot(d, 2 * c);
  if (d >= 0) {
    const double depth = std::sqrt((root + d) / 2);
    return {depth, depth > 0 ? -c / depth : 0};
  }
  const double depth = std::sqrt((root - d) / 2);
  return c > 0 ? VectorDepths{c / depth, -depth} : VectorDepths{-c / depth, depth};
}

MirrorPlane plane_through(const Eigen::Vector2d& tail, const Eigen::Vector3d& a,
                          const Eigen::Vector3d& b) {
  Eigen::Vector3d normal = a.cross(b).normalized();
  if (normal.z() < 0) normal = -normal;
  return {normal, normal.head<2>().dot(tail)};
}

const Stroke& named_vector(const View& view, const std::string& name) {
  const Stroke* found = nullptr;
  for (const Stroke* stroke : strokes_of(view, StrokeKind::plane_vector)) {
    if (stroke->name != name) continue;
    if (found) throw Error("drawn twice: vector " + name, "stroke '" + stroke->id + "'");
    found = stroke;
  }
  if (!found) {
    throw Error("no vector " + name + " of the mirror plane", view_name(view.kind),
                "one stroke each named sym-a and sym-b");
  }
  return *found;
}

/// Sum of d d' over the pairs.
Eigen::Matrix2d moment_of_pairs(const View& view) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Stroke* pair : strokes_of(view, StrokeKind::symmetric_pair)) {
    const Eigen::Vector2d d = pair->points.back() - pair->points.front();
    moment += d * d.transpose();
  }
  return moment;
}

/// The plane whose normal has this direction in the picture and in which both vectors are
/// orthogonal; `drawn` where there is none.
MirrorPlane right_angled_plane(const View& view, const MirrorPlane& drawn, Eigen::Vector2d u) {
  const Stroke& first = named_vector(view, "sym-a");
  const Stroke& second = named_vector(view, "sym-b");
  const Eigen::Vector2d a = first.points.back() - first.points.front();
  const Eigen::Vector2d b = second.points.back() - second.points.front();
  if (u.dot(drawn.normal.head<2>()) < 0) u = -u;
  const double square = -a.dot(b) / (u.dot(a) * u.dot(b));
  if (!(square > 0) || !std::isfinite(square)) return drawn;
  const Eigen::Vector3d normal =
      Eigen::Vector3d(u.x() * std::sqrt(square), u.y() * std::sqrt(square), 1).normalized();
  return {normal, normal.head<2>().dot(first.points.front())};
}

}  // namespace

Eigen::Vector3d mirrored(const MirrorPlane& plane, const Eigen::Vector3d& point) {
  return point - 2 * signed_distance(plane, point) * plane.normal;
}

double signed_distance(const MirrorPlane& plane, const Eigen::Vector3d& point) {
  return plane.normal.dot(point) - plane.offset;
}

MirrorPlanes mirror_planes(const Stroke& a, const Stroke& b, double ratio) {
  if (!(ratio > 0)) throw Error("ratio of lengths is not positive", "mirror plane", "above 0");
  const Eigen::Vector2d a2 = drawn_vector(a);
  const Eigen::Vector2d b2 = drawn_vector(b) * ratio;
  const std::string where = "strokes '" + a.id + "' and '" + b.id + "'";
  if (std::abs(cross(a2, b2)) < kFlatSine * a2.norm() * b2.norm()) {
    throw Error("vectors are parallel: mirror plane seen edge on, depth is not determined", where,
                "a view in which the plane is seen from the side");
  }
  const VectorDepths depth = depths_of(a2, b2);
  if (std::hypot(depth.a, depth.b) < kFlatSine * a2.norm()) {
    throw Error("mirror plane faces the eye: symmetric points coincide in the picture", where,
                "a view in which the plane is seen from the side");
  }
  const bool a_decides = std::abs(depth.a) > kFlatSine * a2.norm();
  const double wanted = (a_decides ? a : b).side == DepthSide::front ? 1 : -1;
  const double sign = (a_decides ? depth.a : depth.b) >= 0 ? wanted : -wanted;
  const auto plane = [&](double s) {
    return plane_through(a.points.front(), {a2.x(), a2.y(), s * depth.a},
                         {b2.x(), b2.y(), s * depth.b});
  };
  return {plane(sign), plane(-sign)};
}

MirrorPlanes drawn_mirror_planes(const View& view, double ratio) {
  const Stroke& a = named_vector(view, "sym-a");
  const Stroke& b = named_vector(view, "sym-b");
  return mirror_planes(a, b, ratio);
}

MirrorPlane plane_from_pairs(const View& view, const MirrorPlane& drawn) {
  const Eigen::Matrix2d moment = moment_of_pairs(view);
  if (!(moment.trace() > 0)) return drawn;
  const Eigen::Vector2d u =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvectors().col(1);
  return right_angled_plane(view, drawn, u);
}

double spread_of_ratio(const View& view, const MirrorPlane& drawn, double noise) {
  const Eigen::Matrix2d moment = moment_of_pairs(view);
  if (!(noise > 0) || !(moment.trace() > 0)) return 0;
  const Eigen::Vector2d u =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvectors().col(1);
  const Eigen::Vector2d a = drawn_vector(named_vector(view, "sym-a"));
  const Eigen::Vector2d b = drawn_vector(named_vector(view, "sym-b"));
  // Both ends of every pair are off.
  const double turn = std::numbers::sqrt2 * noise / std::sqrt(moment.trace());
  const auto ratio = [&](double angle) {
    const Eigen::Vector3d n = right_angled_plane(view, drawn, Eigen::Rotation2Dd(angle) * u).normal;
    return std::hypot(a.norm(), n.head<2>().dot(a) / n.z()) /
           std::hypot(b.norm(), n.head<2>().dot(b) / n.z());
  };
  const double lengths = std::numbers::sqrt2 * noise * std::hypot(1 / a.norm(), 1 / b.norm());
  return std::hypot(std::log(ratio(turn) / ratio(-turn)) / 2, lengths);
}

Eigen::Matrix3d drawn_object_frame(const View& view, const MirrorPlane& plane) {
  const Stroke& a = named_vector(view, "sym-a");
  const Eigen::Vector2d image = a.points.back() - a.points.front();
  const Eigen::Vector3d& n = plane.normal;
  // The vector lies in the plane, which is not seen along its normal's depth.
  const Eigen::Vector3d up =
      Eigen::Vector3d(image.x(), image.y(), -n.head<2>().dot(image) / n.z()).normalized();
  Eigen::Matrix3d frame;
  frame << n.transpose(), up.transpose(), n.cross(up).transpose();
  return frame;
}

}  // namespace geoprior::sketch
