#pragma once

#include <vector>

#include "solvers/fluid/features/segmentation_options.h"
#include "solvers/fluid/features/surface_components.h"

namespace geoprior::fluid {

enum class ComponentRole { bed, drop, bubble };

/// What every component of a frame is. The largest by area is bed; others are drops when they are
/// closed, of its orientation and small beside it (by volume; by area beside an open bed), with
/// handles or without as torn crowns have them, bubbles
/// when closed and of the opposite orientation, else bed.
struct ComponentRoles {
  std::vector<ComponentRole> role;
  bool inside_out = false;  ///< the largest component is oriented inwards (an open one: down)
};
ComponentRoles component_roles(const SurfaceComponents& components,
                               const SegmentationOptions& options);

}  // namespace geoprior::fluid
