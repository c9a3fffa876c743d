#include "tests/support/watched_tests.h"

#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>

namespace geoprior::test {
namespace {

/// Memory of the child that outlives it.
class Progress {
 public:
  Progress() {
    void* memory =
        ::mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no memory to watch the tests in");
    page_ = new (memory) Page;
    say_place("what comes before the tests");
  }
  void say_place(const std::string& place) {
    const std::size_t length = std::min(place.size(), sizeof(page_->place) - 1);
    ::memcpy(page_->place, place.data(), length);
    page_->place[length] = '\0';
  }
  void say_complete() { page_->complete = true; }
  [[nodiscard]] const char* place() const { return page_->place; }
  [[nodiscard]] bool complete() const { return page_->complete; }

 private:
  struct Page {
    char place[1024];
    std::atomic<bool> complete{false};
  };
  Page* page_ = nullptr;  ///< until the process ends
};

bool is_debugged() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("TracerPid:")) return std::stoi(line.substr(10)) != 0;
  }
  return false;
}

/// A process that a death test made of this executable: that test judges how it ends.
bool is_death_test() { return !GTEST_FLAG_GET(internal_run_death_test).empty(); }

int run_tests(double usual_cost, Progress& progress) {
  ::testing::UnitTest::GetInstance()->listeners().Append(
      new CostListener(usual_cost, [&](const std::string& place) { progress.say_place(place); }));
  const int code = RUN_ALL_TESTS();
  progress.say_place("the check for leaks");
  progress.say_complete();
  return code;
}

/// Ends the child: at once, because what a library does at the end may wait for threads that it
/// started when it was loaded, and a fork does not have them.
[[noreturn]] void end_child(int code) {
#if defined(__SANITIZE_ADDRESS__)
  __lsan_do_leak_check();  // comes at the end otherwise
#endif
  std::cout.flush();
  std::fflush(nullptr);
  ::_exit(code);
}

/// Of a child that has ended; says what went wrong with it.
int judge(int status, const Progress& progress) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    std::printf("[  FAILED  ] %s: ended by signal %d (%s)\n", progress.place(), number,
                ::strsignal(number));
    return 128 + number;
  }
  if (progress.complete()) return WEXITSTATUS(status);
  std::printf("[  FAILED  ] %s: the process ended there, with exit code %d\n", progress.place(),
              WEXITSTATUS(status));
  return 1;
}

}  // namespace

int run_watched_tests(double usual_cost) {
  static Progress progress;
  if (is_debugged() || is_death_test()) return run_tests(usual_cost, progress);
  std::fflush(nullptr);  // or the child would write it again
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    end_child(run_tests(usual_cost, progress));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const int code = judge(status, progress);
  if (!GTEST_FLAG_GET(list_tests))
    std::printf("[   COST   ] all of it: %.2f s\n", processor_seconds());
  return code;
}

}  // namespace geoprior::test
