#pragma once

#include <string>
#include <vector>

namespace geoprior {

/// The interpreters that may be asked, best first: GEOPRIOR_PYTHON alone where it is set. The first
/// python3 on PATH is often another build without our packages, so Debian's own comes before it.
std::vector<std::string> python_candidates();

/// What is added to the environment of each. Threads of numpy's BLAS, which our scripts never need,
/// wait busily: a third of a second a script.
const std::vector<std::string>& python_environment();

/// Runs results/<script>.py with Debian's Python; throws Error with its message on failure, naming
/// what to install.
void run_python(const std::string& script, const std::vector<std::string>& arguments);

}  // namespace geoprior
