#pragma once

#include "solvers/grammar/engine/rule.h"

namespace geoprior::grammar {

/// The rules of the objects of models/grammar/objects, each by a function beside its source.
RuleSet tree_rules();
RuleSet building_rules();
RuleSet set_rules();
RuleSet landscape_rules();

/// All of them: types have different names.
RuleSet object_rules();

}  // namespace geoprior::grammar
