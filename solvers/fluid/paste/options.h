#pragma once

#include "core/options.h"

namespace geoprior::fluid {

/// How target vertices find their place in a map: along the map's normal (water, whose waves must
/// not turn the map), along geodesics from the anchor (a curved still mesh), or by the target:
/// geodesics when more than 5 % of the area under the map is steeper than 45 degrees against it.
enum class MappingKind { automatic, projection, exponential };

struct PasteOptions {
  MappingKind mapping = MappingKind::automatic;
  bool refine = true;
  double refine_texels = 2;
  double projection_reach = 1;
  int max_triangles = 4'000'000;
  bool leave_out = false;
};
void describe(OptionVisitor& v, PasteOptions& options);

}  // namespace geoprior::fluid
