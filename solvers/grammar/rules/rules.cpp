#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {

RuleSet object_rules() {
  RuleSet all = tree_rules();
  for (const RuleSet& more : {building_rules(), set_rules(), landscape_rules()}) all.add(more);
  return all;
}

}  // namespace geoprior::grammar
