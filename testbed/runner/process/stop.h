#pragma once

#include <sys/types.h>

#include <exception>
#include <functional>

namespace geoprior {

/// From now on the first Ctrl-C (SIGINT; SIGTERM; SIGHUP of a terminal that is closed, unless it
/// was ignored from the start, as under nohup) asks the run to stop at its next consistent state,
/// the second ends the program at once.
///
/// @throws Error  when no thread can be started (a limit on processes)
void install_stop_handler();

/// True after the first Ctrl-C, or after `request_stop`. The runner's context hands it to the
/// methods.
[[nodiscard]] bool stop_requested() noexcept;

/// What the handler does, for tests; `clear_stop` takes it back.
void request_stop() noexcept;
void clear_stop() noexcept;

/// Ends what has no state worth keeping (drawing, waiting, a child process): unwinds to the
/// command, and files that are not whole are removed on the way.
class Stopped : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "stopped"; }
};

/// @throws Stopped  after a stop request
void throw_if_stopped();

/// While one lives, a stop request ends the program at once with exit code 2, after `farewell`
/// (none: nothing changes). For computations that poll nothing and leave nothing behind: loading a
/// scene, preparing a method, a pose. Not while a file is being written.
class LeaveAtOnce {
 public:
  explicit LeaveAtOnce(const std::function<void()>& farewell);
  ~LeaveAtOnce();
  LeaveAtOnce(const LeaveAtOnce&) = delete;
  LeaveAtOnce& operator=(const LeaveAtOnce&) = delete;

 private:
  bool active_;
};

/// The child process, or minus the process group, that the second Ctrl-C kills together with the
/// program; 0: none.
void end_with_us(pid_t child) noexcept;

}  // namespace geoprior
