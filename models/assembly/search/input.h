#pragma once

#include <optional>
#include <vector>

#include "models/assembly/graph/ported_graph.h"
#include "models/assembly/search/guide.h"
#include "models/assembly/search/rules.h"

namespace geoprior::assembly {

/// Lists what there is in each model, in place of making variations.
struct Survey {
  bool across = false;   ///< substructures of all models replace those of each; else its own
  bool pairs = false;    ///< counts the partners of each substructure, alike ones too
  bool outputs = false;  ///< makes and counts the distinct assemblies of consistent replacements
  bool embeds = true;    ///< closing replacements are made, placed and held against the rules
};

/// What methods of this topic are given.
struct AssemblyInput {
  AssemblySet set;
  Rules rules;
  Guide guide;
  std::optional<Survey> survey;
};

}  // namespace geoprior::assembly
