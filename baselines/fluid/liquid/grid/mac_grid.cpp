#include "baselines/fluid/liquid/grid/mac_grid.h"

namespace geoprior::fluid {

MacGrid::MacGrid(const GridShape& grid) : shape(grid) {
  for (int axis = 0; axis < 3; ++axis) {
    face[axis] = ScalarGrid(grid.face_cells(axis), 0.0F);
  }
}

}  // namespace geoprior::fluid
