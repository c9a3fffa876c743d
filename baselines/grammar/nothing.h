#pragma once

#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// The object at rest, whatever is asked for: it breaks no constraint, and every claim of fidelity
/// is held against it.
inline const Hierarchy& nothing(const Hierarchy& rest) { return rest; }

}  // namespace geoprior::grammar
