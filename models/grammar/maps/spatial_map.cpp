#include "models/grammar/maps/spatial_map.h"

#include <Eigen/LU>
#include <cmath>
#include <sstream>
#include <string>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Distance to the image, per metre of its coordinates, below which Newton's method takes a last
/// step: by then a step squares the error, and one more leaves round-off alone.
constexpr double kNearlyInverted = 1e-9;
constexpr int kMostInverseSteps = 200;
constexpr int kMostHalvings = 40;

std::string point_name(const Vector3d& x) {
  std::ostringstream out;
  out << "point (" << x.x() << ", " << x.y() << ", " << x.z() << ")";
  return out.str();
}

/// The matrix of cofactors: inverse transposed times determinant.
Matrix3d cofactors(const Matrix3d& m) {
  Matrix3d out;
  out.col(0) = m.col(1).cross(m.col(2));
  out.col(1) = m.col(2).cross(m.col(0));
  out.col(2) = m.col(0).cross(m.col(1));
  return out;
}

/// Newton's step from y towards a preimage. Its length says nothing where the map has a fold.
Vector3d newton_step(const Matrix3d& jacobian, const Vector3d& miss, const Vector3d& x) {
  if (!(jacobian.determinant() > 0))
    throw Error("is near a fold of a map that has no inverse", point_name(x),
                "a map whose Jacobian has a positive determinant everywhere");
  return -(jacobian.inverse() * miss);
}

/// Halves the step until it leads nearer to the image.
/// @return  false when no step does
bool nearer_preimage(const SpatialMap& map, const Vector3d& x, const Vector3d& step, Vector3d& y,
                     MappedPoint& image) {
  const double before = (image.position - x).norm();
  double share = 1;
  for (int i = 0; i < kMostHalvings; ++i, share /= 2) {
    const Vector3d next = y + share * step;
    const MappedPoint there = map.with_jacobian(next);
    if (!((there.position - x).norm() < before * (1 - 1e-4 * share))) continue;
    y = next;
    image = there;
    return true;
  }
  return false;
}

/// The better of y and what one more full step makes of it.
Vector3d polished_preimage(const SpatialMap& map, const Vector3d& x, const Vector3d& y,
                           const MappedPoint& image) {
  const Vector3d miss = image.position - x;
  const Vector3d next = y + newton_step(image.jacobian, miss, x);
  return (map.at(next) - x).squaredNorm() < miss.squaredNorm() ? next : y;
}

}  // namespace

MappedPoint SpatialMap::with_jacobian(const Vector3d& x) const {
  MappedPoint out{at(x), {}};
  const double h = difference();
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d above = x, below = x;
    above[axis] += h;
    below[axis] -= h;
    out.jacobian.col(axis) = (at(above) - at(below)) / (above[axis] - below[axis]);
  }
  return out;
}

/// Newton's iteration Q <- (g Q + Q^-T / g) / 2 with Frobenius scaling (Higham 1986), which ends
/// with one unscaled step after the scaling is idle.
Eigen::Quaterniond rotation_of(const Matrix3d& m) {
  Matrix3d Q = m;
  for (int step = 0; step < 60; ++step) {
    const Matrix3d cofactor = cofactors(Q);
    const double determinant = Q.col(0).dot(cofactor.col(0));
    if (!(determinant > 0) || !std::isfinite(determinant))
      throw Error("has the determinant " + std::to_string(determinant), "Jacobian of a map",
                  "a positive one, of a map that turns nothing inside out");
    const Matrix3d inverse = cofactor / determinant;
    // Far from a rotation the scaled step is shorter, near one the plain step is cheaper.
    const double size = Q.squaredNorm();
    const double scale =
        std::abs(size - 3) > 0.5 ? std::sqrt(std::sqrt(inverse.squaredNorm() / size)) : 1;
    const Matrix3d next = (0.5 * scale) * Q + (0.5 / scale) * inverse;
    const double change = (next - Q).cwiseAbs().maxCoeff();
    Q = next;
    if (change < 1e-8) break;
  }
  return Eigen::Quaterniond(Q).normalized();
}

bool reaches(const SpatialMap& map, const Eigen::AlignedBox3d& box) {
  const std::optional<Eigen::AlignedBox3d> support = map.support();
  return !support || (!support->isEmpty() && support->intersects(box));
}

MappedPoint ComposedMap::with_jacobian(const Vector3d& x) const {
  const MappedPoint inner = first_->with_jacobian(x);
  const MappedPoint outer = second_->with_jacobian(inner.position);
  return {outer.position, outer.jacobian * inner.jacobian};
}

std::optional<Eigen::AlignedBox3d> ComposedMap::support() const {
  std::optional<Eigen::AlignedBox3d> out = first_->support();
  const std::optional<Eigen::AlignedBox3d> other = second_->support();
  if (!out || !other) return std::nullopt;
  out->extend(*other);
  return out;
}

Vector3d InverseMap::at(const Vector3d& x) const {
  if (map_->at(x) == x) return x;
  Vector3d y = x;
  MappedPoint image = map_->with_jacobian(y);
  const double near = kNearlyInverted * (1 + x.cwiseAbs().maxCoeff());
  for (int i = 0; i < kMostInverseSteps; ++i) {
    const Vector3d miss = image.position - x;
    if (miss.norm() <= near) return polished_preimage(*map_, x, y, image);
    if (!nearer_preimage(*map_, x, newton_step(image.jacobian, miss, x), y, image)) break;
  }
  throw Error("has no preimage that Newton's method finds", point_name(x),
              "a map whose Jacobian has a positive determinant everywhere");
}

MappedPoint InverseMap::with_jacobian(const Vector3d& x) const {
  const Vector3d y = at(x);
  return {y, map_->with_jacobian(y).jacobian.inverse()};
}

}  // namespace geoprior::grammar
