#pragma once

#include "core/options.h"
#include "models/assembly/graph/compatibility.h"

namespace geoprior::assembly {

/// What every finder of replacements is asked for.
struct MatchingOptions {
  int boundary = 3;
  int parts = 1000;
  bool symmetries = true;
  Matching matching = Matching::observed;
};
void describe(OptionVisitor& v, MatchingOptions& options);
void describe_matching(OptionVisitor& v, Matching& matching);

}  // namespace geoprior::assembly
