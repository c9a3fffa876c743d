#include "testbed/runner/process/jobs.h"

#include <signal.h>  // NOLINT: POSIX, not <csignal>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <map>
#include <thread>
#include <utility>

#include "core/error.h"
#include "testbed/formats/system_reason.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

/// Names the running program, also when a new one was built in its place.
constexpr const char* kThisProgram = "/proc/self/exe";
constexpr int kNotStarted = 127;

/// A file in memory that a job writes: it never waits for a reader.
class Captured {
 public:
  Captured() : descriptor_(::memfd_create("geoprior-job", MFD_CLOEXEC)) {
    if (descriptor_ < 0) throw Error(system_reason(errno), "output of a job");
  }
  ~Captured() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Captured(Captured&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Captured& operator=(Captured&&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] std::string text() const {
    std::string text;
    std::array<char, 1 << 14> block;
    off_t at = 0;
    for (ssize_t n; (n = ::pread(descriptor_, block.data(), block.size(), at)) > 0; at += n) {
      text.append(block.data(), n);
    }
    return text;
  }

 private:
  int descriptor_;
};

struct RunningJob {
  pid_t pid = 0;
  Captured out;
  Captured err;
};

/// Becomes a job: calls only what is allowed after a fork of a program with threads.
[[noreturn]] void become_job(char* const* arguments, pid_t group, const RunningJob& job) {
  ::setpgid(0, group);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::dup2(job.out.descriptor(), STDOUT_FILENO);
  ::dup2(job.err.descriptor(), STDERR_FILENO);
  ::execv(kThisProgram, arguments);
  ::_exit(kNotStarted);
}

/// A job in the process group `group`; 0: in a new one, of its own number. Ctrl-C of a terminal
/// then reaches this program alone, which tells its jobs once. They end when this program does.
pid_t start(const std::vector<std::string>& arguments, pid_t group, const RunningJob& job) {
  std::vector<std::string> words{kThisProgram};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) throw Error(system_reason(errno), "a job cannot be started");
  if (pid == 0) become_job(pointers.data(), group, job);
  ::setpgid(pid, group == 0 ? pid : group);  // whoever of the two comes first
  return pid;
}

/// The jobs that run, in one process group.
class RunningJobs {
 public:
  RunningJobs() = default;
  ~RunningJobs() {
    // Only an error leaves some.
    if (!jobs_.empty()) ::kill(-group_, SIGKILL);
    for (const auto& [index, job] : jobs_) ::waitpid(job.pid, nullptr, 0);
    end_with_us(0);
  }
  RunningJobs(const RunningJobs&) = delete;
  RunningJobs& operator=(const RunningJobs&) = delete;

  [[nodiscard]] int count() const { return static_cast<int>(jobs_.size()); }

  void begin(std::size_t index, const std::vector<std::string>& arguments) {
    RunningJob job;
    // The group lasts as long as a process of it that was not waited for.
    const pid_t group = jobs_.empty() ? 0 : group_;
    job.pid = start(arguments, group, job);
    if (group == 0) group_ = job.pid;
    end_with_us(-group_);
    jobs_.emplace(index, std::move(job));
  }

  void stop() const {
    if (!jobs_.empty()) ::kill(-group_, SIGTERM);
  }

  /// Moves the results of those that have ended to `ended`; does not wait.
  void collect(std::map<std::size_t, JobResult>& ended) {
    for (auto it = jobs_.begin(); it != jobs_.end();) {
      int status = 0;
      if (::waitpid(it->second.pid, &status, WNOHANG) != it->second.pid) {
        ++it;
        continue;
      }
      JobResult& result = ended[it->first];
      if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
      if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
      result.out = it->second.out.text();
      result.err = it->second.err.text();
      it = jobs_.erase(it);
    }
    if (jobs_.empty()) end_with_us(0);
  }

 private:
  std::map<std::size_t, RunningJob> jobs_;
  pid_t group_ = 0;
};

}  // namespace

void run_jobs(const JobArguments& jobs, const std::vector<std::size_t>& order, int at_once,
              const std::function<void(std::size_t, const JobResult&)>& done) {
  constexpr std::chrono::milliseconds kPause{10};
  RunningJobs running;
  std::map<std::size_t, JobResult> ended;
  std::size_t begun = 0;
  std::size_t told = 0;
  for (bool stopping = false; running.count() > 0 || (begun < order.size() && !stopping);) {
    if (stop_requested() && !std::exchange(stopping, true)) running.stop();
    while (!stopping && begun < order.size() && running.count() < at_once) {
      running.begin(order[begun], jobs[order[begun]]);
      ++begun;
    }
    running.collect(ended);
    for (; ended.contains(told); ++told) done(told, ended.at(told));
    if (running.count() > 0) std::this_thread::sleep_for(kPause);
  }
  throw_if_stopped();
}

}  // namespace geoprior
