#pragma once

#include <string>

namespace geoprior {

/// The system's reason for an error number in words that help: "disk full: No space left on
/// device".
std::string system_reason(int error_number);

}  // namespace geoprior
