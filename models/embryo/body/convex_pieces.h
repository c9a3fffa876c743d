#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// A convex body by its support: an ovoid, a flat square, or the hull of two balls.
///
/// An ovoid is convex for every egg that is allowed: its profile (1 + k z) sqrt(1 - z^2) has a
/// second derivative of the sign of -(1 + 3 k z - 2 k z^3), and |3 z - 2 z^3| <= sqrt(2).
class ConvexPiece {
 public:
  static ConvexPiece ovoid(const Shape& shape);
  static ConvexPiece square(const Shape& plane);
  static ConvexPiece balls(const Eigen::Vector3d& a, double radius_a, const Eigen::Vector3d& b,
                           double radius_b);

  /// A point of the body that is farthest along a direction, which need not be of unit length.
  [[nodiscard]] Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  /// A ball that the body lies in.
  [[nodiscard]] const Eigen::Vector3d& center() const { return center_; }
  [[nodiscard]] double reach() const { return reach_; }

 private:
  enum class Kind { ovoid, square, balls };
  [[nodiscard]] Eigen::Vector3d ovoid_support(const Eigen::Vector3d& direction) const;

  Kind kind_ = Kind::balls;
  Eigen::Vector3d center_{0, 0, 0};
  double reach_ = 0;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d radii_{0, 0, 0};
  double egg_ = 0;
  Eigen::Vector3d a_{0, 0, 0}, b_{0, 0, 0};
  double radius_a_ = 0, radius_b_ = 0;
};

/// The pieces that a shape is the union of: one, or of a duct those between points of its centre
/// line, eight a span, which leaves out less than a hundredth of its bulge between two of them.
std::vector<ConvexPiece> convex_pieces(const Shape& shape);

/// Distance of two convex bodies (m), to 1e-9 of it; 0 where they meet.
/// Source: Gilbert, Johnson and Keerthi 1988.
double distance(const ConvexPiece& a, const ConvexPiece& b);

/// Distance of the nearest points of two shapes (m); 0 where they meet.
double gap(const Shape& a, const Shape& b);

/// The largest direction.x over a shape (m).
/// @param direction  unit
double extent_along(const Shape& shape, const Eigen::Vector3d& direction);

}  // namespace geoprior::embryo
