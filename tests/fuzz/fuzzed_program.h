#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace geoprior::test {

/// Seconds of processor time after which a command gets Ctrl-C, and after which it hangs.
inline constexpr double kPatience = 2;
inline constexpr double kHang = 20;

/// Makes a home that of this process, and its working folder.
void enter(const std::filesystem::path& home);

/// The program with all topics, those of the tests among them, on a home, with limits of memory and
/// file size. Called in a child process.
int fuzzed_program(const std::filesystem::path& home, const std::vector<std::string>& arguments);

/// What became of a command.
struct CommandEnd {
  int code = 0;  ///< or minus the signal that ended it
  bool hung = false;
  bool interrupted = false;
  std::string text;  ///< of both streams
};

/// What a user must never see of a command, whatever file it was given.
struct Fault {
  std::string kind;    ///< "hangs"; empty: all is well
  std::string detail;  ///< of this one
};

/// Of a command that has ended.
///
/// Exit code 0, 1 or 2, in time; where it is 2 the last line, and no other, begins with "error: ".
/// No control characters, no pointers, no dumps of libraries.
Fault fault_of(const CommandEnd& end);

}  // namespace geoprior::test
