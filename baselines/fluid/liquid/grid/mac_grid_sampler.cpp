#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"

namespace geoprior::fluid {

Eigen::Vector3d velocity_at(const MacGrid& grid, const Eigen::Vector3d& x) {
  const Eigen::Vector3f cells = ((x - grid.shape.origin) / grid.shape.cell).cast<float>();
  return FaceSampler(grid)(cells).cast<double>();
}

}  // namespace geoprior::fluid
