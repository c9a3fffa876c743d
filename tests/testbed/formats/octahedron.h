#pragma once

#include "core/mesh.h"

namespace geoprior::test {

/// Closed, 6 vertices at distance `radius` from a centre, volume 4/3 radius^3.
inline TriMesh octahedron(double radius = 1,
                          const Eigen::RowVector3d& centre = Eigen::RowVector3d::Zero()) {
  TriMesh mesh{Eigen::MatrixX3d(6, 3), Eigen::MatrixX3i(8, 3)};
  mesh.V << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.V = (radius * mesh.V).rowwise() + centre;
  mesh.F << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  return mesh;
}

}  // namespace geoprior::test
