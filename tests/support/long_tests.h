#pragma once

#include <cstdlib>

namespace geoprior::test {

/// Whether tests named Long… do all that they can (`GEOPRIOR_LONG`): more seeds, more frames, finer
/// meshes. Without it they take the least that shows what they are for.
inline bool at_length() { return std::getenv("GEOPRIOR_LONG") != nullptr; }

}  // namespace geoprior::test
