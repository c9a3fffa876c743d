#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/maps/tools.h"

namespace geoprior::grammar {

/// w(s) = (1 - s)^4 (4 s + 1) for s in 0 … 1: 1 at the tool, 0 with two derivatives at the rim
/// (Wendland 1995). Its steepest slope is -2.11, at s = 1/4.
constexpr double falloff(double s) {
  const double rest = 1 - s;
  return rest * rest * rest * rest * (4 * s + 1);
}

/// The motion of a tool that is small enough to be invertible; the identity beyond its ball. With
/// r = x - centre, s = |r| / radius, w = w(s), a point of the ball goes
///
///   grab      x + w shift                             det = 1 + shift . grad w
///   inflate   x + amount w r
///   twist     centre + R(axis, amount w) r            det = 1: spheres turn in themselves
///   bend      centre + R(axis, amount b u w) r        det = 1 + amount b w v
///
/// with u = r . along / radius, v = r . (along x axis) / radius.
/// b = 1 / max s w(s) = 6.27, so that the largest angle of a bend is its amount, at 0.28 radius.
struct Dab {
  Stroke::Kind kind = Stroke::Kind::grab;
  Eigen::Vector3d centre{0, 0, 0};  ///< m
  double radius = 1;                ///< m
  Eigen::Vector3d shift{0, 0, 0};   ///< grab (m)
  Eigen::Vector3d axis{0, 0, 1};    ///< twist, bend; unit
  Eigen::Vector3d along{1, 0, 0};   ///< bend; unit, perpendicular to `axis`
  double amount = 0;                ///< inflate: strain; twist, bend: rad
};

/// @throws Error  naming `where`: no path, a radius or a strain out of its range, an axis without
///                direction, a number that is not finite, more dabs than 100000
void require_valid(const Stroke& stroke, const std::string& where);

/// The dabs of a fraction of a valid stroke, in order; the last of them is partial. Appended.
///
/// A grab goes along its path in equal steps of at most a fifth of the radius (each dab of a
/// determinant above 0.57); the others share their amount along the path, at the middles of such
/// steps. Dabs of an inflation multiply to 1 + amount at a tool that rests, each of a logarithmic
/// strain of at most 0.4 (determinant above e^-1.2 = 0.30, where a tool shrinks what it is on);
/// those of a bend turn by at most 0.3 rad (above 0.69).
void append_dabs(const Stroke& stroke, double fraction, std::vector<Dab>& out);

/// Dabs one after the other. Each has an inverse, so that all together have one.
class StrokeMap final : public SpatialMap {
 public:
  explicit StrokeMap(std::vector<Dab> dabs);
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override;
  [[nodiscard]] MappedPoint with_jacobian(const Eigen::Vector3d& x) const override;
  /// Around the balls of all dabs; empty where there are none.
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> support() const override { return support_; }

 private:
  std::vector<Dab> dabs_;
  Eigen::AlignedBox3d support_;
};

}  // namespace geoprior::grammar
