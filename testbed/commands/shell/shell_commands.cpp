#include "testbed/commands/shell/shell_commands.h"

#include <sys/stat.h>

#include <array>
#include <ctime>

#include "testbed/commands/shell/completion.h"
#include "testbed/commands/shell/manual.h"
#include "testbed/runner/process/build_info.h"
#include "testbed/streams.h"

namespace geoprior {
namespace {

/// The day on which the running program was made: the page is of its commands.
std::string date_of_program() {
  struct stat status {};
  std::tm day{};
  std::array<char, 16> text{};
  if (::stat("/proc/self/exe", &status) != 0 || ::gmtime_r(&status.st_mtime, &day) == nullptr) {
    return "1970-01-01";
  }
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d", &day)};
}

}  // namespace

int completion_command(const CommandContext& context, const CommandTree& program,
                       const std::string& shell) {
  const OfferedNames names = OfferedNames::of(context.topics);
  if (shell == "bash") print_out(bash_completion(program, names));
  if (shell == "zsh") print_out(zsh_completion(program, names));
  if (shell == "fish") print_out(fish_completion(program, names));
  return done;
}

int manual_command(const CommandTree& program) {
  print_out(manual_page(program, date_of_program(), build_info().version));
  return done;
}

}  // namespace geoprior
