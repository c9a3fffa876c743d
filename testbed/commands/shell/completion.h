#pragma once

#include <string>
#include <vector>

#include "testbed/commands/shell/command_tree.h"
#include "testbed/topic.h"

namespace geoprior {

/// What arguments may be, written into the script: a shell that asked the program at each Tab would
/// wait for it each time, a second on a busy machine. A new shell that sources the output of
/// `geoprior completion` has the new names.
struct OfferedNames {
  std::vector<std::string> experiments;  ///< identifiers
  std::vector<std::string> described;    ///< what `describe` explains

  /// Of the clone's experiment files and of the topics.
  static OfferedNames of(const std::vector<Topic>& topics);
};

/// A script that completes the program's commands, their options and arguments.
std::string bash_completion(const CommandTree& program, const OfferedNames& names);
std::string zsh_completion(const CommandTree& program, const OfferedNames& names);
std::string fish_completion(const CommandTree& program, const OfferedNames& names);

}  // namespace geoprior
