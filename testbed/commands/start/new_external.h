#pragma once

#include <string>

#include "testbed/commands/commands.h"

namespace geoprior {

struct NewRequest {
  std::string kind;  ///< "external"
  std::string topic;
  std::string out;  ///< folder that is made; empty: my-<topic>-method
};

/// Writes a folder to begin with: a program that makes frames, an experiment that measures them
/// beside a variant of the topic's own, and a README.
/// @throws Error  for a topic that is none, and a folder that has something in it
int new_command(const CommandContext& context, const NewRequest& request);

}  // namespace geoprior
