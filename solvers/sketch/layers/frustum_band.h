#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Part of the side of a cone's frustum (of a cylinder, where both radii agree): a rigid layer.
///
/// P(x, s) = rear + x axis + R(x) (cos s up + sin s across), -length <= x <= 0, |s| <= half_angle,
/// across = axis x up, R linear from front_radius at x = -length to rear_radius at x = 0.
struct FrustumBand {
  Eigen::Vector3d rear{0, 0, 0};             ///< centre of the rear rim (m)
  Eigen::Vector3d axis{0, 0, 1};             ///< unit, rearwards
  Eigen::Vector3d up{0, 1, 0};               ///< unit, orthogonal to it
  double length = 0;                         ///< along the axis (m)
  double front_radius = 0, rear_radius = 0;  ///< m
  double half_angle = 0;                     ///< rad

  [[nodiscard]] Eigen::Vector3d across() const;
  [[nodiscard]] double radius_at(double x) const;
  [[nodiscard]] Eigen::Vector3d point(double x, double s) const;
  /// Outward unit normal along the generator s.
  [[nodiscard]] Eigen::Vector3d normal(double s) const;
  /// Coordinates of a point along axis, up and across, from the rear centre.
  [[nodiscard]] Eigen::Vector3d own(const Eigen::Vector3d& P) const;
  /// Length of a generator, s = sqrt(h^2 + (r1 - r2)^2) (m).
  [[nodiscard]] double slant() const;
  /// Where P(x, s) lies in the flat piece, seen from outside, the front upwards, the middle of the
  /// rear rim at the origin (m).
  ///
  /// The rims become arcs of radius rho = r s / |r1 - r2| about one centre, over the angle
  /// 2 half_angle |r1 - r2| / s; a cylinder becomes a rectangle. Written so that digits do not
  /// cancel where the cone is nearly a cylinder, and 0 / 0 does not arise where it is one.
  [[nodiscard]] Eigen::Vector2d unrolled(double x, double s) const;
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
