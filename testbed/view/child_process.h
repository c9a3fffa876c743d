#pragma once

#include <optional>
#include <string>
#include <vector>

namespace geoprior {

/// Path of a program in the folders of PATH, then in /usr/bin.
std::optional<std::string> find_program(const std::string& name);

struct ChildResult {
  int exit_code = 0;   ///< 127 when the program could not be started, 128 + n after signal n
  std::string errors;  ///< what it wrote on its standard error

  /// Why it failed: the last line of `errors` that is not blank (programs warn first and name their
  /// error last), or its exit code.
  [[nodiscard]] std::string reason() const;
};

/// Runs a program to its end without a shell: arguments arrive as they are given. Its standard
/// output goes to our standard error, so that ours stays machine-readable. `environment` adds
/// "NAME=value" entries to ours.
/// @throws Stopped  after a stop request, once the program has been told (SIGTERM) and has ended
ChildResult run_child(const std::vector<std::string>& command,
                      const std::vector<std::string>& environment = {});

}  // namespace geoprior
