#pragma once

#include <string>

#include "testbed/runner/reference.h"

namespace geoprior {

/// A reference file as text (docs/file-formats.md): the same reference gives the same bytes.
/// @throws Error  when a metric has some of min, median, max and last only, or two units
std::string reference_text(const Reference& reference);

/// Reads what `reference_text` writes, strictly.
/// @param source  name of the file, for errors
/// @throws Error  "source:line" with what is wrong there
Reference parse_reference(const std::string& text, const std::string& source);

}  // namespace geoprior
