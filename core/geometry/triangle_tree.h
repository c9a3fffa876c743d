#pragma once

#include <memory>
#include <vector>

#include "core/geometry/surface_point.h"
#include "core/mesh.h"

namespace geoprior {

/// Triangles of a mesh whose corners do not lie on a line (to round-off), in the order of `F`.
std::vector<int> faces_with_area(const TriMesh& mesh);

/// Nearest points of a triangle mesh and what meets it, by a tree of boxes.
///
/// Of the mesh as it is at construction; triangles without area are left out. Numbers are rounded:
/// what touches within round-off may count or not. Queries may be asked from several threads at
/// once.
/// Source: CGAL 5.5, 3D fast intersection and distance computation (AABB tree).
class TriangleTree {
 public:
  explicit TriangleTree(const TriMesh& mesh);
  ~TriangleTree();
  TriangleTree(TriangleTree&&) noexcept;
  TriangleTree& operator=(TriangleTree&&) noexcept;

  struct Nearest {
    SurfacePoint point;   ///< a point on a common edge belongs to either triangle
    double distance = 0;  ///< m
  };
  /// @throws Error  when no triangle has an area
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& x) const;
  /// Squared distance of the nearest point (m^2).
  /// @throws Error  when no triangle has an area
  [[nodiscard]] double squared_distance(const Eigen::Vector3d& x) const;

  /// Whether a triangle has a point in the closed ball.
  [[nodiscard]] bool meets_ball(const Eigen::Vector3d& centre, double squared_radius) const;
  /// Whether a triangle has a point on the closed segment.
  [[nodiscard]] bool meets_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace geoprior
