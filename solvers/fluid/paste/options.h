#pragma once

#include "core/options.h"

namespace geoprior::fluid {

/// How target vertices find their place in a map: along the map's normal (water, whose waves must
/// not turn the map), along geodesics from the anchor (a curved still mesh), or by the target:
/// geodesics when more than 5 % of the area under the map is steeper than 45 degrees against it.
enum class MappingKind { automatic, projection, exponential };

struct PasteOptions {
  MappingKind mapping = MappingKind::automatic;
  bool refine = true;  ///< split target edges longer than `refine_texels` texels under a map
  double refine_texels = 2;
  double projection_reach =
      1;  ///< how far along the normal the target may lie from the map's plane, in extents
  int max_triangles = 4'000'000;  ///< refused beyond, with the size needed
  bool velocity = true;           ///< rates of the displacements are added to known velocities
  bool leave_out = false;  ///< nothing is pasted: the null control of claims about pasted features
};
void describe(OptionVisitor& v, PasteOptions& options);

}  // namespace geoprior::fluid
