#include "baselines/grammar/optimum/optimum.h"

#include "baselines/grammar/optimum/building.h"
#include "baselines/grammar/optimum/sets.h"
#include "baselines/grammar/optimum/tree.h"
#include "core/error.h"

namespace geoprior::grammar {

OptimumResult optimise_object(const Hierarchy& rest, const Hierarchy& children_fixed,
                              const SpatialMap& map) {
  const std::string& object = rest.type(0).name;
  if (object == "tree") return optimise_tree(rest, children_fixed, map);
  if (object == "building") return optimise_building(rest, children_fixed, map);
  if (object == "surface-set" || object == "volume-set" || object == "forest")
    return optimise_set(rest, children_fixed, map);
  throw Error("has no optimum", "object '" + object + "'",
              "tree, building, surface-set, volume-set, forest");
}

}  // namespace geoprior::grammar
