#pragma once

#include <string>

#include "testbed/runner/reference/blessed.h"

namespace geoprior {

/// Reads what `reference_text` writes, strictly.
/// @param source  name of the file, for errors
/// @throws Error  "source:line" with what is wrong there
Reference parse_reference(const std::string& text, const std::string& source);

}  // namespace geoprior
