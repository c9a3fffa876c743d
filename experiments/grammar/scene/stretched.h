#pragma once

#include <Eigen/Core>

#include "experiments/grammar/scene/options.h"

namespace geoprior::grammar {

/// Options of an object whose sizes along x, y, z are multiplied: what a procedure can be told of a
/// deformation. The number of storeys is rounded; spacings and sizes of elements stay.
TreeOptions stretched(TreeOptions options, const Eigen::Vector3d& stretch);
BuildingOptions stretched(BuildingOptions options, const Eigen::Vector3d& stretch);
SurfaceSetOptions stretched(SurfaceSetOptions options, const Eigen::Vector3d& stretch);
VolumeSetOptions stretched(VolumeSetOptions options, const Eigen::Vector3d& stretch);
LandscapeOptions stretched(LandscapeOptions options, const Eigen::Vector3d& stretch);

}  // namespace geoprior::grammar
