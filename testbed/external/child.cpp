#include "testbed/external/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "core/error.h"
#include "testbed/formats/system_reason.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/process/exec_words.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using WallClock = std::chrono::steady_clock;

constexpr int kLookEvery_ms = 20;
constexpr double kMeasureEvery_s = 0.25;  ///< of the folder's size
constexpr std::size_t kKeptOfErrors = 2000;
constexpr double kMegabyte = 1e6;

double seconds_since(WallClock::time_point begin) {
  return std::chrono::duration<double>(WallClock::now() - begin).count();
}

/// Bytes of the files below a folder; links are not followed, what goes meanwhile does not count.
double bytes_below(const fs::path& folder) {
  double bytes = 0;
  std::error_code gone;
  for (auto it = fs::recursive_directory_iterator(
           folder, fs::directory_options::skip_permission_denied, gone);
       !gone && it != fs::recursive_directory_iterator(); it.increment(gone)) {
    std::error_code ignored;
    if (!it->is_regular_file(ignored) || it->is_symlink(ignored)) continue;
    const auto size = it->file_size(ignored);
    if (!ignored) bytes += static_cast<double>(size);
  }
  return bytes;
}

/// The processes whose parent we are, by every thread of ours.
std::set<pid_t> our_children() {
  std::set<pid_t> children;
  std::error_code gone;
  for (const auto& task : fs::directory_iterator("/proc/self/task", gone)) {
    std::ifstream list(task.path() / "children");
    for (pid_t child = 0; list >> child;) children.insert(child);
  }
  return children;
}

/// While one lives, processes whose parents died become our children, so that we can end them.
class Subreaper {
 public:
  Subreaper() : others_(our_children()) { ::prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0); }
  ~Subreaper() {
    end_orphans();
    ::prctl(PR_SET_CHILD_SUBREAPER, 0, 0, 0, 0);
  }
  Subreaper(const Subreaper&) = delete;
  Subreaper& operator=(const Subreaper&) = delete;

  /// Kills what the command left: its children become ours as their parents go, until there are
  /// none.
  void end_orphans() const {
    for (bool found = true; found;) {
      found = false;
      for (const pid_t child : our_children()) {
        if (others_.contains(child)) continue;
        found = true;
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
      }
    }
  }

 private:
  std::set<pid_t> others_;
};

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw Error(system_reason(errno), "a pipe");
  }
  ~Pipe() {
    for (const int end : ends) {
      if (end >= 0) ::close(end);
    }
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_writer() { ::close(std::exchange(ends[1], -1)); }
};

/// What the child needs, made before the fork: after it only calls that are safe there.
struct Launch {
  std::vector<char*> arguments;
  std::vector<char*> variables;
  const char* folder;
  rlim_t largest_file;  ///< bytes: one more than may be written, so that who is cut off is seen
  int errors;
  int report;  ///< the error number of a failed start goes here
};

[[noreturn]] void become_command(const Launch& launch) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL, 0, 0, 0);
  ::setpgid(0, 0);
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ, SIGCHLD}) {
    ::sigaction(signal, &usual, nullptr);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const rlimit file{launch.largest_file, launch.largest_file}, no_core{0, 0};
  ::setrlimit(RLIMIT_FSIZE, &file);
  ::setrlimit(RLIMIT_CORE, &no_core);
  const int nothing = ::open("/dev/null", O_RDWR);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(nothing, STDOUT_FILENO);
  ::dup2(launch.errors, STDERR_FILENO);
  // Whatever is open here (the journal, files of libraries) stays here.
  ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (::chdir(launch.folder) == 0) {
    ::execvpe(launch.arguments.front(), launch.arguments.data(), launch.variables.data());
  }
  const int why = errno;
  ::_exit(::write(launch.report, &why, sizeof why) == sizeof why ? 127 : 126);
}

/// The last bytes that a program wrote, read as they come so that it never waits for us.
class TailOfErrors {
 public:
  explicit TailOfErrors(int descriptor) : descriptor_(descriptor) {
    ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
  }
  /// Takes what is there; waits for a little where there is nothing.
  void take() {
    pollfd ready{descriptor_, POLLIN, 0};
    (void)::poll(&ready, 1, kLookEvery_ms);
    // An end that is closed is ready at once, always.
    if ((ready.revents & (POLLHUP | POLLIN)) == POLLHUP) (void)::poll(nullptr, 0, kLookEvery_ms);
    drain();
  }
  void drain() {
    std::array<char, 65536> block;
    for (int blocks = 0; blocks < 64; ++blocks) {
      const ssize_t n = ::read(descriptor_, block.data(), block.size());
      if (n <= 0) return;
      text_.append(block.data(), static_cast<std::size_t>(n));
      if (text_.size() > kKeptOfErrors) text_.erase(0, text_.size() - kKeptOfErrors);
    }
  }
  /// On one line, without control characters.
  [[nodiscard]] std::string text() const {
    std::string line;
    bool is_between = false;
    for (const char c : text_) {
      const bool is_end = c == '\n' || c == '\r';
      if (!is_end && !line.empty() && is_between) line += " | ";
      is_between = is_end;
      if (!is_end) line += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? ' ' : c;
    }
    return line;
  }

 private:
  int descriptor_;
  std::string text_;
};

/// A command that was started.
class RunningCommand {
 public:
  /// @param given  bytes that lie in the folder already
  RunningCommand(pid_t pid, const fs::path& folder, double given, const CommandLimits& limits)
      : pid_(pid), folder_(folder), given_(given), limits_(limits) {
    ::setpgid(pid, pid);  // as the child does: whoever is first
    end_with_us(-pid);
  }
  ~RunningCommand() {
    kill_all();
    if (!status_) ::waitpid(pid_, nullptr, 0);
    end_with_us(0);
  }
  RunningCommand(const RunningCommand&) = delete;
  RunningCommand& operator=(const RunningCommand&) = delete;

  /// Waits for the end; ends it where it is late, writes too much, or we are to stop.
  void wait(TailOfErrors& errors, const RunContext& context, CommandEnd& end) {
    double measured_at = 0;
    while (!has_ended(end)) {
      errors.take();
      const double now = seconds_since(begin_);
      if (context.stop_requested()) {
        end.stopped = true;
      } else if (now > limits_.seconds) {
        end.failure = "was ended after " + number_text(limits_.seconds) + " s (time_limit_s)";
      } else if (now - measured_at > kMeasureEvery_s) {
        measured_at = now;
        require_little(end);
      }
      if (end.stopped || !end.failure.empty()) {
        kill_all();
        while (!has_ended(end)) errors.take();
        return;
      }
    }
    require_little(end);
  }

  [[nodiscard]] int status() const { return status_.value_or(0); }

 private:
  bool has_ended(CommandEnd& end) {
    int status = 0;
    rusage use{};
    if (::wait4(pid_, &status, WNOHANG, &use) != pid_) return false;
    status_ = status;
    end.wall_s = seconds_since(begin_);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    end.processor_s = seconds(use.ru_utime) + seconds(use.ru_stime);
    end.peak_MB = static_cast<double>(use.ru_maxrss) * 1024 / kMegabyte;
    return true;
  }
  void require_little(CommandEnd& end) const {
    if (bytes_below(folder_) - given_ <= limits_.megabytes * kMegabyte) return;
    end.failure = "wrote more than " + number_text(limits_.megabytes) + " MB (output_limit_MB)";
  }
  void kill_all() const {
    ::kill(-pid_, SIGKILL);
    if (!status_) ::kill(pid_, SIGKILL);
  }

  pid_t pid_;
  fs::path folder_;
  double given_;
  CommandLimits limits_;
  WallClock::time_point begin_ = WallClock::now();
  std::optional<int> status_;
};

std::string failure_of(int status, double megabytes) {
  if (WIFSIGNALED(status)) {
    if (WTERMSIG(status) == SIGXFSZ) {
      return "wrote a file of more than " + number_text(megabytes) + " MB (output_limit_MB)";
    }
    return "was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
           ::strsignal(WTERMSIG(status)) + ")";
  }
  return WEXITSTATUS(status) == 0 ? "" : "ended with code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

CommandEnd run_external_command(const std::vector<std::string>& command, const fs::path& folder,
                                const std::vector<std::string>& environment,
                                const CommandLimits& limits, const RunContext& context) {
  const Subreaper subreaper;
  Pipe errors, report;
  std::vector<std::string> arguments = command, variables = merged_environment(environment);
  const std::string working_folder = folder.string();
  const Launch launch{null_terminated(arguments),
                      null_terminated(variables),
                      working_folder.c_str(),
                      static_cast<rlim_t>(limits.megabytes * kMegabyte) + 1,
                      errors.ends[1],
                      report.ends[1]};
  const double given = bytes_below(folder);
  const pid_t pid = ::fork();
  if (pid < 0) throw Error("cannot be started: " + system_reason(errno), command.front());
  if (pid == 0) become_command(launch);
  CommandEnd end;
  RunningCommand running(pid, folder, given, limits);
  errors.close_writer();
  report.close_writer();
  int why = 0;
  if (::read(report.ends[0], &why, sizeof why) == sizeof why) {
    std::error_code ignored;
    end.failure = "cannot be started: ";
    if (fs::is_directory(folder / command.front(), ignored)) {
      end.failure += "is a folder";
    } else {
      end.failure += std::strerror(why);
      if (why == ENOENT && fs::exists(folder / command.front(), ignored)) {
        end.failure += " (the interpreter that its first line names)";
      }
    }
    return end;
  }
  TailOfErrors tail(errors.ends[0]);
  running.wait(tail, context, end);
  tail.drain();
  if (end.failure.empty() && !end.stopped)
    end.failure = failure_of(running.status(), limits.megabytes);
  if (!end.failure.empty() && !tail.text().empty()) {
    end.failure += "; the end of its standard error: " + tail.text();
  }
  return end;
}

}  // namespace geoprior
