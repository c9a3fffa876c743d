#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "models/embryo/shape/shape.h"
#include "models/embryo/surface/duct.h"

/// The signed field whose zero set is the surface of a structure, or of structures fused into one.
///
/// Negative inside. Each field is a bound of the distance: |f(x)| is at most the distance to the
/// surface, and f changes by no more than x moves, so that a ball of radius |f(x)| about x holds no
/// surface and whole bricks of space need no look.
///
///   ovoid      f = r_min (|q| - 1), q = (x/(a s), y/(b s), z/c), s = 1 + egg z/c, r_min = min(a,
///   b, c):
///              the distance for a ball, up to r_min / r_max of it for the poles of a long ovoid
///   cylinder   distance to the segment that leaves room for its round caps, minus the radius
///   duct       min over t of |x - p(t)| - r(t): the union of balls along the centre line
///   fused      smin(a, b) = min(a, b) - max(k - |a - b|, 0)^2 / (4 k), member by member
///   divided    smax(f, -slab), slab = smax(|n.(x - p)| - thickness/2, descent.(x - p) - tip)
///   half       smax(f, thickness/2 - side n.(x - p))
///
/// with smax(a, b) = -smin(-a, -b) of width thickness/2, which rounds the edge of the cut. Members
/// that are not fused never blend: two structures that touch stay two surfaces.
///
/// What it cannot do: the blend of an ovoid is wider where its field rises slower than the
/// distance; three members that meet within k blend in the order in which they are given; a duct
/// that bends tighter than its radius is still the union of its balls, but its field is no better
/// than 1 % there; an ovoid with an egg has a field that grows by up to (1 + 2|egg|)/(1 - |egg|)
/// times what x moves (`change` knows).
/// Source: Quilez 2013 (polynomial smooth minimum, exact in its two arguments); thesis 2.3.
namespace geoprior::embryo {

/// What divides a structure: a slab that descends into it, or, of a product, the plane that it ends
/// at.
struct Septum {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d descent = Eigen::Vector3d::UnitY();  ///< unit
  double tip = 0;        ///< how far along `descent` from the point the slab has come (m)
  double thickness = 0;  ///< m
  int side = 0;          ///< 0: cut out of the whole; 1 or -1: the half on that side of the normal
};

/// A structure in a field: an ovoid, a cylinder or a duct, whole or divided.
struct Solid {
  int structure = 0;
  Shape shape;
  std::optional<Septum> septum;
};

/// The plain formulas of single primitives.
double ovoid_field(const Shape& ovoid, const Eigen::Vector3d& x);
double cylinder_field(const Shape& cylinder, const Eigen::Vector3d& x);
/// From all pieces, without any short cut.
double duct_field(std::span<const DuctPiece> pieces, const Eigen::Vector3d& x);
double divided_field(const Septum& septum, double whole, const Eigen::Vector3d& x, double rounding);

/// The field of one solid, or of several fused with a blend.
class SolidField {
 public:
  /// @param blend  k of the smooth minimum between members (m), 0 or more
  /// @param sharp  neither blends nor rounds: the plain union
  /// @throws Error  on a landmark, a radius that is not positive, an egg beyond 0.5, a number that
  ///                is not finite (names the structure)
  SolidField(std::vector<Solid> solids, double blend, bool sharp = false);

  /// Pieces of ducts that can be nearest in some ball, ascending.
  using Near = std::vector<int>;

  /// The formulas above, all pieces looked at.
  [[nodiscard]] double value(const Eigen::Vector3d& x) const;
  /// The same number, bit for bit, where `near` holds for a ball that x lies in.
  [[nodiscard]] double value(const Eigen::Vector3d& x, const Near& near) const;

  [[nodiscard]] Near all_pieces() const;
  /// Those of `from` that can be nearest to some point of the ball.
  void narrow(const Near& from, const Eigen::Vector3d& center, double radius, Near& out) const;

  /// By how much the field can differ between x and x + d, wherever x is. A norm of d.
  [[nodiscard]] double change(const Eigen::Vector3d& d) const;
  /// A lower bound of the field's slope on the surface: 1 for cylinders and ducts, about r_min /
  /// r_max for ovoids; 0, unknown, for what is blended or divided.
  [[nodiscard]] double least_slope() const;
  /// max of direction.x over the solid (m), or somewhat more.
  [[nodiscard]] double support(const Eigen::Vector3d& direction) const;
  /// Index of the member whose own field is least at x: the structure that a place belongs to.
  [[nodiscard]] int nearest_member(const Eigen::Vector3d& x, const Near& near) const;

  [[nodiscard]] const std::vector<Solid>& solids() const { return solids_; }
  /// Of all members (m).
  [[nodiscard]] double smallest_radius() const { return smallest_radius_; }
  /// Of the uncut members together (m^2), to a tenth or two.
  [[nodiscard]] double area_estimate() const;

 private:
  double member_field(int member, const Eigen::Vector3d& x, const int*& near,
                      const int* near_end) const;
  double member_support(int member, const Eigen::Vector3d& direction) const;

  std::vector<Solid> solids_;
  std::vector<DuctPiece> pieces_;  ///< of all ducts, member by member
  std::vector<int> first_piece_;   ///< of each member, and the end
  double blend_ = 0;
  bool sharp_ = false;
  double smallest_radius_ = 0;
};

}  // namespace geoprior::embryo
