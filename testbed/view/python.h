#pragma once

#include <string>
#include <vector>

namespace geoprior {

/// Runs results/<script>.py with Debian's Python; throws Error with its message on failure, naming
/// what to install.
void run_python(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace geoprior
