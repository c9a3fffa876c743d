#include "testbed/runner/process/stop.h"

#include <semaphore.h>
#include <signal.h>  // NOLINT: POSIX, not <csignal>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>

#include "core/error.h"
#include "testbed/streams.h"

namespace geoprior {
namespace {

constexpr int kStoppedExitCode = 2;

volatile sig_atomic_t stop_flag = 0;
std::atomic<pid_t> child_to_end{0};
static_assert(std::atomic<pid_t>::is_always_lock_free);

/// What a thread of its own does at a stop request: a signal handler may neither print nor lock.
struct Leaving {
  sem_t requested;
  std::mutex mutex;  ///< held while the program leaves
  std::function<void()> farewell;

  Leaving() { ::sem_init(&requested, 0, 0); }
};

/// Never destroyed: its thread waits until the program is gone.
Leaving& leaving() {
  static Leaving& the_one = *new Leaving;
  return the_one;
}

extern "C" void on_stop_signal(int signal) {
  const int error_of_interrupted_call = errno;
  if (stop_flag != 0) {
    if (const pid_t child = child_to_end.load(); child != 0) ::kill(child, SIGKILL);
    ::signal(signal, SIG_DFL);
    ::raise(signal);
  }
  stop_flag = 1;
  ::sem_post(&leaving().requested);
  errno = error_of_interrupted_call;
}

[[noreturn]] void leave(const std::function<void()>& farewell) {
  try {
    farewell();
  } catch (const std::exception& error) {
    say(std::string("error: ") + error.what());
  }
  ::_exit(kStoppedExitCode);
}

void leave_when_requested() {
  for (;;) {
    while (::sem_wait(&leaving().requested) != 0) {
    }
    const std::lock_guard lock(leaving().mutex);
    if (leaving().farewell) leave(leaving().farewell);
  }
}

}  // namespace

void install_stop_handler() {
  static std::once_flag once;
  // Makes what the handler uses, before there is a handler.
  (void)leaving();
  try {
    std::call_once(once, [] { std::thread(leave_when_requested).detach(); });
  } catch (const std::system_error& error) {
    throw Error(std::string("cannot start a thread: ") + error.code().message(), "geoprior",
                "a limit on processes (ulimit -u) that leaves room for a few");
  }
  // SA_RESTART: writing a frame is never interrupted half-way by the first signal.
  struct sigaction action {};
  action.sa_handler = on_stop_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction inherited {};
  sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool stop_requested() noexcept { return stop_flag != 0; }
void request_stop() noexcept { stop_flag = 1; }
void clear_stop() noexcept { stop_flag = 0; }

void throw_if_stopped() {
  if (stop_requested()) throw Stopped();
}

LeaveAtOnce::LeaveAtOnce(const std::function<void()>& farewell)
    : active_(static_cast<bool>(farewell)) {
  if (!active_) return;
  const std::lock_guard lock(leaving().mutex);
  if (stop_requested()) leave(farewell);
  leaving().farewell = farewell;
}

LeaveAtOnce::~LeaveAtOnce() {
  if (!active_) return;
  const std::lock_guard lock(leaving().mutex);
  leaving().farewell = nullptr;
}

void end_with_us(pid_t child) noexcept { child_to_end = child; }

}  // namespace geoprior
