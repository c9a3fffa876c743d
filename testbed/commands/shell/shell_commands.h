#pragma once

#include <string>

#include "testbed/commands/commands.h"
#include "testbed/commands/shell/command_tree.h"

namespace geoprior {

/// `geoprior completion bash|zsh|fish`: the script, on stdout.
int completion_command(const CommandContext& context, const CommandTree& program,
                       const std::string& shell);

/// `geoprior manual`: the manual page, on stdout.
int manual_command(const CommandTree& program);

}  // namespace geoprior
