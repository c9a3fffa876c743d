#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "models/details/surface_walk.h"

namespace geoprior::details {

/// Third corner of a triangle unfolded over an edge into the plane.
///
/// @param a, b    ends of the edge in the plane; the triangle comes to lie right of a -> b
/// @param xa, xb  the same in space
/// @param xc      the corner in space
Eigen::Vector2d unfold_corner(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                              const Eigen::Vector3d& xa, const Eigen::Vector3d& xb,
                              const Eigen::Vector3d& xc);

/// Straight rays that leave a point of a surface: the faces that a ray crosses are unfolded into
/// the plane of the point's face, where the ray is a straight line. Which edge it leaves by is
/// decided by the side of one corner alone, so that no round-off can lead it astray. Source:
/// Polthier, Schmies 1998 (straightest geodesics, away from vertices).
class SurfaceRays {
 public:
  SurfaceRays(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x)
      : surface_(surface), x_(x) {}

  /// @param tangent  its part in the plane of the face counts
  void start(const SurfacePoint& at, const Eigen::Vector3d& tangent);
  /// Corners of the point's face in the plane, the point at 0.
  [[nodiscard]] const std::array<Eigen::Vector2d, 3>& corners() const { return corner_; }
  [[nodiscard]] const Eigen::Vector3d& tangent() const { return tangent_; }
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }

  /// Points at increasing distances along a ray; beyond a border, the last point before it.
  /// @param ray  unit vector in the plane: (1, 0) runs along the tangent, (0, 1) to its left
  void trace(const Eigen::Vector2d& ray, std::span<const double> distance,
             std::span<Eigen::Vector3d> points) const;

 private:
  const SurfaceTopology& surface_;
  std::span<const Eigen::Vector3d> x_;
  int face_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d tangent_ = Eigen::Vector3d::UnitX();
  std::array<Eigen::Vector2d, 3> corner_;
};

}  // namespace geoprior::details
