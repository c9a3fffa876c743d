#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Developable band between two circles across a mirror plane: a rigid layer.
///
/// The rear rim is rear + rear_radius (cos s up + sin s across), |s| <= half_angle, across =
/// axis x up. The front rim's centre lies `length` before it along the axis and `front_rise`
/// beside it; its plane is turned by `front_tilt` about across.
///
/// Without tilt and rise it is part of the side of a cone's frustum (of a cylinder, where both
/// radii agree): P(x, s) = rear + x axis + R(x) (cos s up + sin s across), -length <= x <= 0, R
/// linear.
///
/// With them no right cone has both circles. The band is the part of the border of their convex
/// hull that planes touch which are tangent to both: the generator from rear point s ends at the
/// front's t(s), where the tangents of both circles and the generator lie in one plane,
///   a sin t - L sin s cos t = -r sin s sin tilt,  a = L cos s cos tilt - (R - rise cos s) sin
///   tilt,
/// and x / -length is the share of the generator. It is a torse: its flat piece is exact.
struct FrustumBand {
  Eigen::Vector3d rear{0, 0, 0};             ///< centre of the rear rim (m)
  Eigen::Vector3d axis{0, 0, 1};             ///< unit, rearwards
  Eigen::Vector3d up{0, 1, 0};               ///< unit, orthogonal to it
  double length = 0;                         ///< along the axis (m)
  double front_radius = 0, rear_radius = 0;  ///< m
  double half_angle = 0;                     ///< rad
  double front_tilt = 0;                     ///< positive: the crown rearwards (rad)
  double front_rise = 0;                     ///< along up (m)

  [[nodiscard]] bool oblique() const { return front_tilt != 0 || front_rise != 0; }
  [[nodiscard]] Eigen::Vector3d across() const;
  [[nodiscard]] Eigen::Vector3d point(double x, double s) const;
  /// Outward unit normal along the generator s.
  [[nodiscard]] Eigen::Vector3d normal(double s) const;
  /// Coordinates of a point along axis, up and across, from the rear centre.
  [[nodiscard]] Eigen::Vector3d own(const Eigen::Vector3d& P) const;
  /// Distance of a point behind the plane of the front rim (m).
  [[nodiscard]] double behind_front(const Eigen::Vector3d& P) const;
  /// Of a frustum: how far a point is from the axis, less the radius of the side there (m).
  [[nodiscard]] double height_above(const Eigen::Vector3d& P) const;
  /// Angle t on the front rim at which the generator s ends.
  [[nodiscard]] double front_angle(double s) const;
  /// Whether no generator within the band crosses the plane of the other rim.
  [[nodiscard]] bool rims_are_apart() const;
  /// Whether a point between the planes of both rims lies at least a depth below the band, or below
  /// what goes on from it around; true of points that are not between them.
  [[nodiscard]] bool has_below(const Eigen::Vector3d& P, double depth) const;

  struct Place {
    double x = 0, s = 0;
  };
  /// Where the line along across through a point of the mirror plane (own coordinates) meets the
  /// band, on the side of positive s.
  [[nodiscard]] Place side_place(const Eigen::Vector3d& own) const;
  /// Height along up of the lower border, moved up by a margin along the band, at an axial place.
  [[nodiscard]] double lower_border(double axial, double margin) const;
  /// Length of the generator in the middle, of a frustum of each: s = sqrt(h^2 + (r1 - r2)^2) (m).
  [[nodiscard]] double slant() const;
  /// Where P(x, s) lies in the flat piece, seen from outside, the front upwards, the middle of the
  /// rear rim at the origin (m).
  ///
  /// Of a frustum the rims become arcs of radius rho = r s / |r1 - r2| about one centre, over the
  /// angle 2 half_angle |r1 - r2| / s; a cylinder becomes a rectangle. Written so that digits do
  /// not cancel where the cone is nearly a cylinder, and 0 / 0 does not arise where it is one. Of
  /// an oblique band the rear rim keeps its geodesic curvature, which is integrated (fourth order,
  /// 1e-10 of the radius), and generators their lengths and their angles with it.
  [[nodiscard]] Eigen::Vector2d unrolled(double x, double s) const;

 private:
  [[nodiscard]] double radius_at(double x) const;
  [[nodiscard]] Eigen::Vector3d own_rear(double s) const;
  [[nodiscard]] Eigen::Vector3d own_front(double t) const;
  [[nodiscard]] Eigen::Vector3d own_generator(double s) const;  ///< from rear rim to front rim
  [[nodiscard]] Eigen::Vector3d own_normal(double s) const;
  [[nodiscard]] Eigen::Vector2d unrolled_oblique(double x, double s) const;
};

/// Steps of the angle along a rim, and of a generator.
struct BandGrid {
  int around = 48;
  int along = 2;
};

/// The band as an open surface: vertex (i, k) is i * (around + 1) + k, row i = 0 at the front,
/// k = 0 at s = -half_angle. Triangles counter-clockwise seen from outside.
TriMesh band_sheet(const FrustumBand& band, const BandGrid& grid);

/// The band as a closed solid: the sheet outside, its offset by `thickness` along the normals
/// inside.
TriMesh band_solid(const FrustumBand& band, double thickness, const BandGrid& grid);

}  // namespace geoprior::sketch
