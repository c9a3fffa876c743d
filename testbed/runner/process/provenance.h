#pragma once

#include <map>
#include <string>

namespace geoprior {

/// What a run was made by and on: program, commit, compiler, flags, libraries, processor, system.
std::map<std::string, std::string> provenance();

}  // namespace geoprior
