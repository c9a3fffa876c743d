#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/assembly/graph/ported_graph.h"

namespace geoprior::assembly {

/// What files of assemblies hold, and what was not understood of them.
struct ReadAssemblies {
  AssemblySet set;
  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> files;
};

}  // namespace geoprior::assembly
