#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

namespace geoprior {

/// Complete elliptic integrals K(k) and E(k) of modulus k, 0 <= k < 1, by the arithmetic-geometric
/// mean, to round-off.
struct EllipticIntegrals {
  double first = 0;   ///< K = int_0^(pi/2) dt / sqrt(1 - k^2 sin^2 t)
  double second = 0;  ///< E = int_0^(pi/2) sqrt(1 - k^2 sin^2 t) dt
};
/// @throws Error  on a modulus out of range
EllipticIntegrals elliptic_integrals(double modulus);

/// Height of the middle of an inextensible elastic strip over the line through its ends (m), when
/// the ends are pinned (free to turn) and pushed together: Euler's elastica, first mode, no weight.
///
/// With k the sine of half the slope at the ends: distance / length = 2 E(k) / K(k) - 1 and height
/// / length = k / K(k). The height does not depend on the stiffness, so a sheet bent to a cylinder
/// has the same. Small shortening: height = (2 / pi) sqrt(length (length - distance)).
///
/// @param length    of the strip (m), positive
/// @param distance  of its ends (m), 0 … length
/// @throws Error    when they are out of range
/// Source: Love, A Treatise on the Mathematical Theory of Elasticity, 1927, art. 263.
double elastica_height(double length, double distance);

/// Two opposite sides of a rectangle in the plane, corner to corner, both the same way.
struct Strip {
  using Side = std::array<Eigen::Vector2d, 2>;
  Side first, second;

  /// `s` along the sides, `t` from the first to the second.
  [[nodiscard]] Eigen::Vector2d at(double s, double t) const;
  [[nodiscard]] double length() const;  ///< from side to side, in their middle (m)
};
/// The strip between two segments, if they are equal and parallel sides of a rectangle whose area
/// is all that there is, to a millionth; absent otherwise. Either may run the other way.
/// @param area  of the sheet (m^2)
std::optional<Strip> strip_between(const Strip::Side& first, const Strip::Side& second,
                                   double area);

/// A line across a bent strip, from one held end to the other.
struct BentLine {
  Eigen::Vector3d start, middle, end;  ///< m
};
/// How a strip stands over the line through its ends, mean of lines across it (m).
struct StripRise {
  double distance = 0;  ///< of the ends
  double height = 0;    ///< of the middle over the line
};
/// @param lines  at least one, none whose ends are one point
StripRise strip_rise(std::span<const BentLine> lines);

}  // namespace geoprior
