#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "testbed/topic.h"

namespace geoprior::test {

/// A child process in a group of its own. It ends, with all that it started, when this does.
class ProgramProcess {
 public:
  /// @param body    runs in the child and gives its exit code; it may replace the child (exec)
  /// @param output  file that gets stdout and stderr
  ProgramProcess(const std::function<int()>& body, const std::filesystem::path& output);
  ~ProgramProcess();
  ProgramProcess(const ProgramProcess&) = delete;
  ProgramProcess& operator=(const ProgramProcess&) = delete;

  /// To the child alone; nothing once it has been seen to end.
  void signal(int number) const;
  /// Exit code, or minus the signal that ended it.
  int wait();
  /// The same once it has ended; does not wait.
  std::optional<int> poll();
  /// Of the processor, used by the child itself so far; 0 once it has ended.
  [[nodiscard]] double processor_seconds() const;

 private:
  std::optional<int> collect(int flags);

  int pid_ = -1;
  std::optional<int> ended_;
};

/// Replaces this process by a program; returns only when there is none.
int become_program(const std::string& program, const std::vector<std::string>& arguments);

/// What `main` of the program does, without its start: loading the libraries takes a quarter of a
/// second, a fork of a process that has them some milliseconds. The forking process must not have
/// started threads (TBB).
int run_as_program(const std::vector<std::string>& arguments, const std::vector<Topic>& topics);

}  // namespace geoprior::test
