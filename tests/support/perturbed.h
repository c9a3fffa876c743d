#pragma once

#include <cstdlib>

namespace geoprior {

/// How many perturbed good files a reader is tried on: 20, or what the environment variable
/// GEOPRIOR_PERTURBED_FILES says (300 in ./test.sh --long).
inline int perturbed_files() {
  const char* said = std::getenv("GEOPRIOR_PERTURBED_FILES");
  return said == nullptr ? 20 : std::atoi(said);
}

}  // namespace geoprior
