#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/connectivity.h"
#include "core/geometry/surface_point.h"
#include "core/mesh.h"

namespace geoprior::details {

/// The part of the smooth surface that no deformation changes: triangles and their neighbours.
struct SurfaceTopology {
  explicit SurfaceTopology(const TriMesh& rest);

  [[nodiscard]] int face_count() const { return static_cast<int>(face.size()); }

  /// Corners 3 f + k of the faces around a vertex, ascending.
  [[nodiscard]] std::span<const int> corners_of(int vertex) const { return corners.of(vertex); }
  /// Faces met when one walks around a vertex from neighbour to neighbour: all of its faces on a
  /// manifold.
  [[nodiscard]] int fan_of(int vertex) const;

  std::vector<std::array<int, 3>> face;  ///< vertices
  /// Face across the edge from vertex k to vertex k + 1; -1 at a border.
  std::vector<std::array<int, 3>> across;
  VertexCorners corners;
  std::vector<char> border_vertex;
  std::vector<double> rest_area;  ///< of the faces (m^2)
  int euler = 0;                  ///< V - E + F
};

/// Position of a point on the surface whose vertices are now at `x`.
inline Eigen::Vector3d position_of(const SurfacePoint& p, const SurfaceTopology& surface,
                                   std::span<const Eigen::Vector3d> x) {
  const auto& f = surface.face[p.face];
  return p.barycentric[0] * x[f[0]] + p.barycentric[1] * x[f[1]] + p.barycentric[2] * x[f[2]];
}

/// Area of a face now (m^2).
double area_of_face(int face, const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x);

/// Unit normal of a face now.
Eigen::Vector3d normal_of_face(int face, const SurfaceTopology& surface,
                               std::span<const Eigen::Vector3d> x);

/// Nearest point of the surface to `target`, found by walking: from face to neighbouring face as
/// long as the distance falls. A local answer, which is what is wanted: the other side of a thin
/// neck is never reached, however near it lies. Cost: the faces crossed.
SurfacePoint walk_to_nearest(const SurfacePoint& start, const Eigen::Vector3d& target,
                             const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x);

/// Straightest path of a given length on the surface: leaves `start` in direction `direction`
/// (projected to the face's plane) and is unfolded over every edge it crosses; ends early at a
/// border.
/// Source: Polthier, Schmies 1998 (away from vertices).
SurfacePoint trace_straight(const SurfacePoint& start, const Eigen::Vector3d& direction,
                            double length, const SurfaceTopology& surface,
                            std::span<const Eigen::Vector3d> x);

/// Tangent direction of an angle in the frame of a face, and back.
Eigen::Vector3d tangent_direction(int face, double angle, const SurfaceTopology& surface,
                                  std::span<const Eigen::Vector3d> x);
double tangent_angle(int face, const Eigen::Vector3d& direction, const SurfaceTopology& surface,
                     std::span<const Eigen::Vector3d> x);

}  // namespace geoprior::details
