#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace geoprior::fluid {

/// Discrete exponential map: surface points by direction and distance from an anchor, unrolled into
/// the anchor's tangent plane, and the anchor's axes transported to every vertex.
struct ExponentialMap {
  std::vector<int> vertices;          ///< those reached, ascending
  std::vector<Eigen::Vector2d> uv;    ///< m, along the first two axes
  std::vector<Eigen::Matrix3d> axes;  ///< columns: transported axes, the third is the normal
};

/// @param positions, triangles  of the surface, outward oriented
/// @param triangle  that holds the anchor
/// @param anchor    point of that triangle (m)
/// @param axes      orthonormal, right-handed; turned on the shortest way until the third is the
///                  surface's normal at the anchor
/// @param radius    geodesic distance up to which the map goes on (m); vertices one ring beyond it
///                  get coordinates too
///
/// Vertices settle in order of their distance along edges; coordinates and axes of one are the mean
/// (weights 1/edge) of what its settled neighbours predict by unrolling the edge between them.
/// Exact on planes; on other developable surfaces to first order in the edges; on curved ones
/// distorted with the total curvature, and not injective beyond the cut locus.
/// Sources: Schmidt, Grimm and Wyvill 2006; upwind averaging: Schmidt 2013.
ExponentialMap exponential_map(std::span<const Eigen::Vector3d> positions,
                               std::span<const std::array<int, 3>> triangles, int triangle,
                               const Eigen::Vector3d& anchor, const Eigen::Matrix3d& axes,
                               double radius);

/// `axes` turned on the shortest way so that the third column is the unit vector `normal`.
Eigen::Matrix3d turned_to(const Eigen::Matrix3d& axes, const Eigen::Vector3d& normal);

}  // namespace geoprior::fluid
