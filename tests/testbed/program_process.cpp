#include "tests/testbed/program_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "core/error.h"
#include "core/freed_memory.h"
#include "testbed/program.h"

namespace geoprior::test {
namespace {

/// Program and arguments as `execv` and `main` take them; they point into `words`.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> command_line(const std::string& program,
                                      const std::vector<std::string>& arguments) {
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

/// An empty file, before the child is there: what another one wrote is not taken for its words.
int open_output(const std::filesystem::path& file) {
  const int out = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (out < 0) throw Error("cannot open " + file.string());
  return out;
}

void redirect_output(int out) {
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
}

}  // namespace

ProgramProcess::ProgramProcess(const std::function<int()>& body,
                               const std::filesystem::path& output) {
  const int out = open_output(output);
  std::fflush(nullptr);  // or the child would write it again
  pid_ = ::fork();
  if (pid_ != 0) ::close(out);
  if (pid_ < 0) throw Error("fork failed");
  if (pid_ > 0) {
    ::setpgid(pid_, pid_);
    return;
  }
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  redirect_output(out);
  const int code = body();
  std::cout.flush();
  std::fflush(nullptr);
  ::_exit(code);
}

ProgramProcess::~ProgramProcess() {
  if (pid_ <= 0) return;
  ::kill(-pid_, SIGKILL);
  wait();
}

void ProgramProcess::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

int ProgramProcess::wait() { return *collect(0); }

std::optional<int> ProgramProcess::poll() { return collect(WNOHANG); }

double ProgramProcess::processor_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (::clock_getcpuclockid(pid_, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

std::optional<int> ProgramProcess::collect(int flags) {
  if (ended_) return ended_;
  int status = 0;
  if (::waitpid(pid_, &status, flags) == 0) return std::nullopt;
  ::kill(-pid_, SIGKILL);  // what it left behind
  pid_ = -1;
  ended_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return ended_;
}

int become_program(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = command_line(program, arguments);
  ::execv(program.c_str(), pointers_to(words).data());
  return 127;
}

int run_as_program(const std::vector<std::string>& arguments, const std::vector<Topic>& topics) {
  keep_freed_memory();
  std::vector<std::string> words = command_line("geoprior", arguments);
  return run_program(static_cast<int>(words.size()), pointers_to(words).data(), topics);
}

}  // namespace geoprior::test
