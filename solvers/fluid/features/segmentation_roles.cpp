#include "solvers/fluid/features/segmentation_roles.h"

#include <algorithm>

namespace geoprior::fluid {

ComponentRoles component_roles(const SurfaceComponents& components,
                               const SegmentationOptions& options) {
  ComponentRoles result;
  if (components.list.empty()) return result;
  const auto largest =
      std::max_element(components.list.begin(), components.list.end(),
                       [](const auto& a, const auto& b) { return a.area < b.area; });
  result.inside_out = largest->closed ? largest->volume < 0 : largest->upward < 0;
  const double outward = result.inside_out ? -1 : 1;
  for (const SurfaceComponent& c : components.list) {
    ComponentRole role = ComponentRole::bed;
    if (&c != &*largest && c.closed && c.vertices > 3) {
      const bool small =
          largest->closed ? std::abs(c.volume) <= options.largest_drop * std::abs(largest->volume)
                          : c.area <= options.largest_drop * largest->area;
      if (outward * c.volume < 0) role = ComponentRole::bubble;
      if (outward * c.volume > 0 && small) role = ComponentRole::drop;
    }
    result.role.push_back(role);
  }
  return result;
}

}  // namespace geoprior::fluid
