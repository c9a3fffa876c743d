#include "models/embryo/surface/field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "core/error.h"
#include "models/embryo/shape/smooth_minimum.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

constexpr double kWidestEgg = 0.5;
/// Beyond |q| = 2 an egg's field goes on as that of the ellipsoid around it, or it would rise
/// without a bound.
constexpr double kEggReach = 2;

/// By how much |q| rises, at most, per unit of (x/a, y/b, z/c).
double egg_slope(double egg) {
  return egg == 0 ? 1 : (1 + kEggReach * std::abs(egg)) / (1 - std::abs(egg));
}

/// Half axes of the ellipsoid around an egg.
Vector3d outer_radii(const Shape& ovoid) {
  const double wide = 1 + std::abs(ovoid.egg);
  return ovoid.radii.cwiseProduct(Vector3d(wide, wide, 1));
}

/// Half the length between the centres of the caps.
double half_segment(const Shape& cylinder) {
  return std::max(cylinder.radii.z() - cylinder.radii.x(), 0.0);
}

void require_solid(const Solid& solid) {
  const Shape& s = solid.shape;
  const std::string where = "structure " + std::to_string(solid.structure);
  if (!is_solid(s.primitive)) throw Error("a landmark has no surface", where, "solids");
  if (!s.center.allFinite() || !s.axes.allFinite() || !s.radii.allFinite())
    throw Error("a number of its shape is not finite", where, "finite numbers");
  if (!(smallest_radius(s) > 0) || !std::isfinite(s.radius + s.end_radius))
    throw Error("a radius is not positive", where, "positive radii");
  if (!(std::abs(s.egg) <= kWidestEgg)) throw Error("egg out of range", where, "-0.5 to 0.5");
  if (s.primitive == Primitive::duct && s.points.empty())
    throw Error("a duct without control points", where, "one or more");
  if (solid.septum && !(solid.septum->thickness > 0))
    throw Error("a septum without thickness", where, "positive thickness");
}

double capsule_area(double radius, double length) {
  return 2 * std::numbers::pi * radius * (length + 2 * radius);
}

/// Thomsen's formula, within 1.1 %.
double ellipsoid_area(const Vector3d& r) {
  const double p = 1.6075;
  const Vector3d q = r.array().pow(p);
  return 4 * std::numbers::pi *
         std::pow((q.x() * q.y() + q.y() * q.z() + q.z() * q.x()) / 3, 1 / p);
}

}  // namespace

double ovoid_field(const Shape& ovoid, const Vector3d& x) {
  const double r_min = ovoid.radii.minCoeff();
  const Vector3d local = ovoid.axes.transpose() * (x - ovoid.center);
  Vector3d q = local.cwiseQuotient(ovoid.radii);
  if (ovoid.egg == 0) return r_min * (q.norm() - 1);
  q.head<2>() /= 1 + ovoid.egg * std::clamp(q.z(), -1.0, 1.0);
  const double outer = local.cwiseQuotient(outer_radii(ovoid)).norm();
  return r_min * (std::max(std::min(q.norm(), kEggReach), outer) - 1);
}

double cylinder_field(const Shape& cylinder, const Vector3d& x) {
  const Vector3d from = x - cylinder.center, axis = cylinder.axes.col(2);
  const double half = half_segment(cylinder);
  return (from - std::clamp(from.dot(axis), -half, half) * axis).norm() - cylinder.radii.x();
}

double duct_field(std::span<const DuctPiece> pieces, const Vector3d& x) {
  double best = std::numeric_limits<double>::infinity();
  for (const DuctPiece& piece : pieces) best = std::min(best, piece_distance(piece, x));
  return best;
}

double divided_field(const Septum& septum, double whole, const Vector3d& x, double rounding) {
  const double across = septum.normal.dot(x - septum.point), half = septum.thickness / 2;
  if (septum.side != 0) return smooth_maximum(whole, half - septum.side * across, rounding);
  const double down = septum.descent.dot(x - septum.point) - septum.tip;
  return smooth_maximum(whole, -smooth_maximum(std::abs(across) - half, down, rounding), rounding);
}

SolidField::SolidField(std::vector<Solid> solids, double blend, bool sharp)
    : solids_(std::move(solids)), blend_(sharp ? 0 : blend), sharp_(sharp) {
  if (solids_.empty()) throw Error("a surface of no structure", "", "one or more");
  if (!(blend >= 0) || !std::isfinite(blend))
    throw Error("blend out of range", "structure " + std::to_string(solids_.front().structure),
                "0 or more metres");
  smallest_radius_ = std::numeric_limits<double>::infinity();
  for (const Solid& solid : solids_) {
    require_solid(solid);
    smallest_radius_ = std::min(smallest_radius_, embryo::smallest_radius(solid.shape));
    first_piece_.push_back(static_cast<int>(pieces_.size()));
    if (solid.shape.primitive != Primitive::duct) continue;
    const std::vector<DuctPiece> own = duct_pieces(solid.shape);
    pieces_.insert(pieces_.end(), own.begin(), own.end());
  }
  first_piece_.push_back(static_cast<int>(pieces_.size()));
}

/// @param near  the first piece at or after the member's own, moved past them
double SolidField::member_field(int member, const Vector3d& x, const int*& near,
                                const int* near_end) const {
  const Solid& solid = solids_[member];
  double f = std::numeric_limits<double>::infinity();
  if (solid.shape.primitive == Primitive::ovoid) {
    f = ovoid_field(solid.shape, x);
  } else if (solid.shape.primitive == Primitive::cylinder) {
    f = cylinder_field(solid.shape, x);
  } else {
    for (; near != near_end && *near < first_piece_[member + 1]; ++near)
      if (piece_bound(pieces_[*near], x) < f) f = std::min(f, piece_distance(pieces_[*near], x));
  }
  if (!solid.septum) return f;
  return divided_field(*solid.septum, f, x, sharp_ ? 0 : solid.septum->thickness / 2);
}

double SolidField::value(const Vector3d& x) const {
  double f = std::numeric_limits<double>::infinity();
  for (int m = 0; m < static_cast<int>(solids_.size()); ++m) {
    const Solid& solid = solids_[m];
    const std::size_t count = first_piece_[m + 1] - first_piece_[m];
    double own = solid.shape.primitive == Primitive::ovoid ? ovoid_field(solid.shape, x)
                 : solid.shape.primitive == Primitive::cylinder
                     ? cylinder_field(solid.shape, x)
                     : duct_field({pieces_.data() + first_piece_[m], count}, x);
    if (solid.septum)
      own = divided_field(*solid.septum, own, x, sharp_ ? 0 : solid.septum->thickness / 2);
    f = m == 0 ? own : smooth_minimum(f, own, blend_);
  }
  return f;
}

double SolidField::value(const Vector3d& x, const Near& near) const {
  const int* piece = near.data();
  const int* const end = piece + near.size();
  double f = member_field(0, x, piece, end);
  for (int m = 1; m < static_cast<int>(solids_.size()); ++m)
    f = smooth_minimum(f, member_field(m, x, piece, end), blend_);
  return f;
}

SolidField::Near SolidField::all_pieces() const {
  Near out(pieces_.size());
  std::iota(out.begin(), out.end(), 0);
  return out;
}

/// At every point of the ball a piece has at least its bound at the centre less the radius, and the
/// nearest one at most the value at the centre plus the radius.
void SolidField::narrow(const Near& from, const Vector3d& center, double radius, Near& out) const {
  out.clear();
  const int* near = from.data();
  const int* const end = near + from.size();
  for (int m = 0; m < static_cast<int>(solids_.size()); ++m) {
    const int* const begin = near;
    double nearest = std::numeric_limits<double>::infinity();
    for (; near != end && *near < first_piece_[m + 1]; ++near)
      if (piece_bound(pieces_[*near], center) < nearest)
        nearest = std::min(nearest, piece_distance(pieces_[*near], center));
    const double reach = nearest + 2.0001 * radius;
    for (const int* p = begin; p != near; ++p)
      if (piece_bound(pieces_[*p], center) <= reach) out.push_back(*p);
  }
}

double SolidField::change(const Vector3d& d) const {
  constexpr double kRoundOff = 1 + 1e-6;
  double most = 0;
  for (const Solid& solid : solids_) {
    const Shape& s = solid.shape;
    const bool ovoid = s.primitive == Primitive::ovoid;
    double own = d.norm();
    if (ovoid)
      own = s.radii.minCoeff() * egg_slope(s.egg) *
            (s.axes.transpose() * d).cwiseQuotient(s.radii).norm();
    if (solid.septum) own = std::max(own, d.norm());
    most = std::max(most, own);
  }
  return kRoundOff * most;
}

double SolidField::least_slope() const {
  if (solids_.size() > 1 || solids_.front().septum) return 0;
  const Shape& s = solids_.front().shape;
  if (s.primitive != Primitive::ovoid) return 1;
  return s.radii.minCoeff() / s.radii.maxCoeff() / (1 + std::abs(s.egg));
}

double SolidField::member_support(int member, const Vector3d& direction) const {
  const Shape& s = solids_[member].shape;
  // Where all others blend in, the surface lies where the member's own field is this.
  const double level = blend_ / 4 * (static_cast<double>(solids_.size()) - 1);
  const Vector3d local = s.axes.transpose() * direction;
  if (s.primitive == Primitive::ovoid)
    return direction.dot(s.center) +
           (1 + level / s.radii.minCoeff()) * local.cwiseProduct(outer_radii(s)).norm();
  if (s.primitive == Primitive::cylinder)
    return direction.dot(s.center) + half_segment(s) * std::abs(local.z()) +
           (s.radii.x() + level) * direction.norm();
  double most = -std::numeric_limits<double>::infinity();
  for (int p = first_piece_[member]; p < first_piece_[member + 1]; ++p) {
    const DuctPiece& piece = pieces_[p];
    most = std::max(most, direction.dot(piece.start) + std::max(direction.dot(piece.chord), 0.0) +
                              (piece.largest_radius + piece.sagitta + level) * direction.norm());
  }
  return most;
}

double SolidField::support(const Vector3d& direction) const {
  double most = -std::numeric_limits<double>::infinity();
  for (int m = 0; m < static_cast<int>(solids_.size()); ++m)
    most = std::max(most, member_support(m, direction));
  return most;
}

int SolidField::nearest_member(const Vector3d& x, const Near& near) const {
  const int* piece = near.data();
  const int* const end = piece + near.size();
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int m = 0; m < static_cast<int>(solids_.size()); ++m) {
    const double own = member_field(m, x, piece, end);
    if (!(own < least)) continue;
    least = own;
    best = m;
  }
  return best;
}

double SolidField::area_estimate() const {
  double sum = 0;
  for (int m = 0; m < static_cast<int>(solids_.size()); ++m) {
    const Shape& s = solids_[m].shape;
    if (s.primitive == Primitive::ovoid) sum += ellipsoid_area(s.radii);
    if (s.primitive == Primitive::cylinder) sum += capsule_area(s.radii.x(), 2 * half_segment(s));
    double length = 0;
    for (int p = first_piece_[m]; p < first_piece_[m + 1]; ++p) length += pieces_[p].chord.norm();
    if (s.primitive == Primitive::duct) sum += capsule_area((s.radius + s.end_radius) / 2, length);
  }
  return sum;
}

}  // namespace geoprior::embryo
