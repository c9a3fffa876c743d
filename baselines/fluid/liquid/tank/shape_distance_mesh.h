#pragma once

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "core/mesh.h"

namespace geoprior::fluid {

/// Signed distance of a closed mesh at the nodes of a grid around it (m).
struct MeshDistance {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of node (0, 0, 0)
  double cell = 1;                                   ///< between nodes (m)
  ScalarGrid nodes;

  /// Trilinear; outside of the grid the value on its border plus the way to it.
  [[nodiscard]] double operator()(const Eigen::Vector3d& x) const;
};

/// Exact distances within two cells of the surface, signed by angle-weighted pseudonormals; beyond
/// them the Eikonal equation |grad d| = 1 by fast sweeping (first order).
///
/// @param mesh  closed, manifold, outward oriented
/// @param cell  between nodes; made larger where the grid would pass 2^24 nodes
/// Sources: Bærentzen and Aanæs 2005; Zhao 2005.
MeshDistance mesh_distance(const TriMesh& mesh, double cell);

}  // namespace geoprior::fluid
