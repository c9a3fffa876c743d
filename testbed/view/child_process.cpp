#include "testbed/view/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT: POSIX, not <csignal>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

#include "core/error.h"
#include "testbed/runner/process/exec_words.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

constexpr auto kPatience = std::chrono::seconds(5);  ///< between SIGTERM and SIGKILL

/// A program that was started: told to end when we are asked to stop, and waited for in any case.
class Child {
 public:
  Child(pid_t pid, int errors) : pid_(pid), errors_(errors) { end_with_us(pid); }
  ~Child() {
    end_with_us(0);
    ::close(errors_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  ChildResult result() {
    ChildResult result;
    bool is_writing = true;
    while (is_writing || !exit_code_) {
      is_writing = is_writing && read_some(result.errors);
      if (!is_writing) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      tell_of_stop();
      look_for_end();
      // Programs that it started itself may keep its stream open.
      if (told_ && exit_code_) break;
    }
    result.exit_code = *exit_code_;
    return result;
  }

 private:
  /// What it wrote within a tenth of a second; false at the end.
  bool read_some(std::string& text) const {
    constexpr int kMilliseconds = 100;
    pollfd ready{errors_, POLLIN, 0};
    const int count = ::poll(&ready, 1, kMilliseconds);
    if (count == 0 || (count < 0 && errno == EINTR)) return true;
    std::array<char, 4096> block;
    const ssize_t n = ::read(errors_, block.data(), block.size());
    if (n > 0) text.append(block.data(), static_cast<std::size_t>(n));
    return n > 0 || (n < 0 && errno == EINTR);
  }

  void look_for_end() {
    if (exit_code_) return;
    int status = 0;
    const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) {
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    } else if (ended < 0 && errno != EINTR) {
      exit_code_ = 127;
    }
  }

  void tell_of_stop() {
    if (!stop_requested()) return;
    const auto now = std::chrono::steady_clock::now();
    const bool is_news = !told_;
    if (is_news) told_ = now;
    if (exit_code_) return;
    if (is_news) ::kill(pid_, SIGTERM);
    if (now - *told_ > kPatience) ::kill(pid_, SIGKILL);
  }

  pid_t pid_;
  int errors_;
  std::optional<int> exit_code_;
  std::optional<std::chrono::steady_clock::time_point> told_;
};

/// Signals that we ignore (run_program) mean to a child what they usually mean.
void set_usual_signals(posix_spawnattr_t& attributes) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGPIPE);
  sigaddset(&signals, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
}

}  // namespace

std::string ChildResult::reason() const {
  const std::size_t end = errors.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) {
    if (exit_code > 128) return "was ended by signal " + std::to_string(exit_code - 128);
    return "ended with code " + std::to_string(exit_code);
  }
  const std::size_t before = errors.find_last_of("\r\n", end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return errors.substr(begin, end + 1 - begin);
}

std::optional<std::string> find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string folders = path != nullptr ? path : "";
  folders += ":/usr/bin";
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const std::string file = folders.substr(begin, end - begin) + "/" + name;
    if (::access(file.c_str(), X_OK) == 0) return file;
    begin = end + 1;
  }
  return std::nullopt;
}

ChildResult run_child(const std::vector<std::string>& command,
                      const std::vector<std::string>& environment) {
  throw_if_stopped();
  std::vector<std::string> arguments = command;
  std::vector<std::string> variables = merged_environment(environment);
  std::array<int, 2> errors{};
  if (::pipe2(errors.data(), O_CLOEXEC) != 0) {
    throw Error(std::strerror(errno), command.front(), "a free file descriptor");
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors[1], STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  set_usual_signals(attributes);
  pid_t pid = 0;
  const int failure =
      ::posix_spawnp(&pid, command.front().c_str(), &actions, &attributes,
                     null_terminated(arguments).data(), null_terminated(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(errors[1]);
  if (failure != 0) {
    ::close(errors[0]);
    return {127, std::strerror(failure)};
  }
  ChildResult result = Child(pid, errors[0]).result();
  throw_if_stopped();
  return result;
}

}  // namespace geoprior
