#include "testbed/view/display.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT: POSIX, not <csignal>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include "core/error.h"
#include "testbed/runner/process/stop.h"
#include "testbed/view/child_process.h"

namespace geoprior {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kStartTimeout = std::chrono::seconds(20);
// A server that ends gives up its socket before its lock: one that starts in between takes the
// number and dies of the lock. Another program's pictures are reason enough to try again.
constexpr int kStarts = 5;
const std::string kInstallDisplay = "apt-get install xvfb libgl1-mesa-dri";

/// Whether the X server named by DISPLAY answers. libX11 is loaded at run time: VTK brings it along
/// and nothing else here needs its headers.
bool user_display_answers() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') return false;
  void* library = ::dlopen("libX11.so.6", RTLD_NOW);
  if (library == nullptr) return false;
  using Open = void* (*)(const char*);
  using Close = int (*)(void*);
  const auto open = reinterpret_cast<Open>(::dlsym(library, "XOpenDisplay"));
  const auto close = reinterpret_cast<Close>(::dlsym(library, "XCloseDisplay"));
  void* display = open != nullptr ? open(nullptr) : nullptr;
  if (display != nullptr && close != nullptr) close(display);
  return display != nullptr;
}

/// The number that Xvfb writes to its -displayfd once it accepts connections; empty when it died or
/// the deadline passed.
std::string read_display_number(int descriptor, Clock::time_point deadline) {
  std::string text;
  while (text.find('\n') == std::string::npos) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    pollfd wait{descriptor, POLLIN, 0};
    if (left.count() <= 0 || stop_requested()) return {};
    if (::poll(&wait, 1, static_cast<int>(left.count())) < 0 && errno == EINTR) continue;
    std::array<char, 16> block{};
    const ssize_t n = ::read(descriptor, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return {};
    text.append(block.data(), static_cast<std::size_t>(n));
  }
  return text.substr(0, text.find('\n'));
}

[[noreturn]] void become_xvfb(const char* program, int number_out, pid_t parent) {
  ::setpgid(0, 0);                     // Ctrl-C ends us first, and we end it
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // kill -9 of us ends it too
  if (::getppid() != parent) ::_exit(1);
  const int silent = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(silent, stream);
  constexpr int kNumberStream = 3;
  if (number_out == kNumberStream) {
    ::fcntl(kNumberStream, F_SETFD, 0);
  } else {
    ::dup2(number_out, kNumberStream);
  }
  ::execl(program, "Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp",
          "-noreset", "+extension", "GLX", static_cast<char*>(nullptr));
  ::_exit(127);
}

}  // namespace

class Display::Server {
 public:
  explicit Server(const std::string& program) {
    const Clock::time_point deadline = Clock::now() + kStartTimeout;
    std::string text;
    for (int i = 0; i < kStarts && text.empty() && Clock::now() < deadline; ++i) {
      text = start(program, deadline);
      if (text.empty()) throw_if_stopped();
    }
    if (text.empty()) throw Error("the virtual display did not start", program, kInstallDisplay);
    if (const char* old = std::getenv("DISPLAY")) old_display_ = old;
    ::setenv("DISPLAY", (":" + text).c_str(), 1);
  }

  ~Server() {
    stop();
    if (old_display_) {
      ::setenv("DISPLAY", old_display_->c_str(), 1);
    } else {
      ::unsetenv("DISPLAY");
    }
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

 private:
  /// The number of the display that runs now; empty, with nothing left running, when none does.
  std::string start(const std::string& program, Clock::time_point deadline) {
    std::array<int, 2> number{};
    if (::pipe2(number.data(), O_CLOEXEC) != 0) throw Error(std::strerror(errno), "Xvfb");
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ == 0) become_xvfb(program.c_str(), number[1], parent);
    ::close(number[1]);
    const std::string text = pid_ > 0 ? read_display_number(number[0], deadline) : std::string();
    ::close(number[0]);
    if (text.empty()) stop();
    return text;
  }

  void stop() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
  }

  pid_t pid_ = -1;
  std::optional<std::string> old_display_;
};

Display::Display() {
  // Found before the fork: a forked child of a threaded program may only call async-signal-safe
  // functions.
  if (const auto xvfb = find_program("Xvfb")) {
    server_ = std::make_unique<Server>(*xvfb);
  } else if (!user_display_answers()) {
    throw Error("no display to draw on: Xvfb is not installed", "render", kInstallDisplay);
  }
}

Display::~Display() = default;

}  // namespace geoprior
