#include "experiments/grammar/scene/stretched.h"

#include <algorithm>
#include <cmath>

namespace geoprior::grammar {

TreeOptions stretched(TreeOptions options, const Eigen::Vector3d& stretch) {
  options.height *= stretch.z();
  options.spread *= std::sqrt(stretch.x() * stretch.y()) / stretch.z();
  return options;
}

BuildingOptions stretched(BuildingOptions options, const Eigen::Vector3d& stretch) {
  options.width *= stretch.x();
  options.depth *= stretch.y();
  options.storeys = std::max(1, static_cast<int>(std::lround(options.storeys * stretch.z())));
  return options;
}

SurfaceSetOptions stretched(SurfaceSetOptions options, const Eigen::Vector3d& stretch) {
  options.width *= stretch.x();
  options.depth *= stretch.y();
  options.height *= stretch.z();
  return options;
}

VolumeSetOptions stretched(VolumeSetOptions options, const Eigen::Vector3d& stretch) {
  options.width *= stretch.x();
  options.depth *= stretch.y();
  options.height *= stretch.z();
  return options;
}

LandscapeOptions stretched(LandscapeOptions options, const Eigen::Vector3d& stretch) {
  options.width *= stretch.x();
  options.depth *= stretch.y();
  options.relief *= stretch.z();
  return options;
}

}  // namespace geoprior::grammar
