#include "baselines/fluid/liquid/grid/mac_grid.h"

#include "baselines/fluid/liquid/grid/mac_grid_sampler.h"

namespace geoprior::fluid {

MacGrid::MacGrid(const GridShape& grid) : shape(grid) {
  for (int axis = 0; axis < 3; ++axis) {
    face[axis] = ScalarGrid(grid.face_cells(axis), 0.0F);
  }
}

Eigen::Vector3d MacGrid::velocity(const Eigen::Vector3d& x) const {
  const Eigen::Vector3f cells = ((x - shape.origin) / shape.cell).cast<float>();
  return FaceSampler(*this)(cells).cast<double>();
}

}  // namespace geoprior::fluid
