#include "baselines/embryo/plain_union.h"

namespace geoprior::embryo {

std::vector<StructureMesh> plain_union(const DayState& day, SurfaceOptions options) {
  options.blend = false;
  return day_meshes(day, options);
}

}  // namespace geoprior::embryo
