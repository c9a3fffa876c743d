#pragma once

#include <string>
#include <vector>

namespace geoprior {

/// Arguments or environment as the calls that start a program want them: pointers into the texts,
/// which must outlive them, and a null.
std::vector<char*> null_terminated(std::vector<std::string>& texts);

/// Our environment with "NAME=value" entries added, in place of ours of the same name.
std::vector<std::string> merged_environment(const std::vector<std::string>& added);

}  // namespace geoprior
