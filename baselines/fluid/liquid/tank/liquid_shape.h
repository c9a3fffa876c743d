#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior::fluid {

/// A body given by its signed distance: a primitive about its own centre, or a closed mesh.
struct LiquidShape {
  enum class Kind { box, sphere, cylinder, half_space, mesh };
  Kind kind = Kind::box;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();     ///< m; a point of the half space's border
  Eigen::Vector3d half_size = Eigen::Vector3d::Ones();  ///< of the box (m)
  double radius = 0.1;                                  ///< of sphere and cylinder (m)
  Eigen::Vector3d axis =
      Eigen::Vector3d::UnitZ();  ///< unit: cylinder; outward normal of the half space
  double half_length = 0.1;      ///< of the cylinder (m)
  TriMesh mesh;                  ///< closed, outward oriented, where it stands at t = 0
};

}  // namespace geoprior::fluid
