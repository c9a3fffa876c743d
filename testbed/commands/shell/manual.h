#pragma once

#include <string>

#include "testbed/commands/shell/command_tree.h"

namespace geoprior {

/// The manual page geoprior(1) in the macros of man(7), from what the commands say of themselves.
/// @param date     of the program, "2025-01-31"
/// @param version  of the program, "0.1.0"
std::string manual_page(const CommandTree& program, const std::string& date,
                        const std::string& version);

}  // namespace geoprior
