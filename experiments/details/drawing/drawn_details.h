#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/details/scene.h"

namespace geoprior::details {

/// What drawing needs of a detail.
struct DrawnAnchor {
  SurfacePoint at;
  double weight = 1;
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();  ///< in the surface, any length
  int type = 0;
};

/// Details as geometry.
struct DrawnDetails {
  TriMesh mesh;
  Eigen::MatrixX3d normals;  ///< unit, one row a vertex: for smooth shading
  std::vector<int> detail;   ///< of each vertex: number of the anchor; -1: of none
};

}  // namespace geoprior::details
