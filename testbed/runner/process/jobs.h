#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace geoprior {

/// How a job ended, and all that it wrote.
struct JobResult {
  int exit_code = 0;  ///< meaningless where a signal ended it
  int signal = 0;     ///< that ended it; 0: it ended by itself
  std::string out;
  std::string err;
};

/// Arguments of this program, one list a job.
using JobArguments = std::vector<std::vector<std::string>>;

/// Runs this program once a job, at most `at_once` at the same time, each in a process of its own:
/// a crash, a limit of threads or of memory is that of one job.
///
/// The first Ctrl-C lets the running jobs stop at their next consistent state and begins no other;
/// the second ends them at once, together with this program.
///
/// @param order    in which they are begun: indices of jobs, each once
/// @param done     gets index and result of each job in the order of the indices, whatever the
///                 order in which they end
/// @throws Stopped  after Ctrl-C, when no job runs any more
/// @throws Error    when no process can be started
void run_jobs(const JobArguments& jobs, const std::vector<std::size_t>& order, int at_once,
              const std::function<void(std::size_t, const JobResult&)>& done);

}  // namespace geoprior
