#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior {

#ifdef NDEBUG
inline constexpr bool kIsDebugBuild = false;
#else
inline constexpr bool kIsDebugBuild = true;
#endif

struct ExecuteRequest {
  std::optional<std::filesystem::path>
      out;  ///< --out; absent: results/runs/<id>/<timestamp>-<short hash>
  bool resume = false;
  bool show_progress = false;  ///< bar on stderr
  bool timing = true;          ///< run the benchmark after the frames
  /// A diagnostic that the topic's table lacks is an error (of tests, checks and debug builds);
  /// otherwise it is recorded without a unit.
  bool only_declared = kIsDebugBuild;
  /// What the program says of the run's folder before a stop request ends it at once, while nothing
  /// is written (`LeaveAtOnce`); absent: it stops at the next consistent state only.
  std::function<void(const std::filesystem::path& folder)> farewell;
};

struct ExecuteResult {
  std::filesystem::path folder;
  RunRecord record;
  bool stopped = false;       ///< Ctrl-C: the folder can be resumed
  bool was_finished = false;  ///< --resume of a finished run: nothing was done
};

/// Runs an experiment: load each case's scene, run its variants, record, measure, time, decide
/// claims, assemble run.h5. Pictures are the caller's: they are drawn from the folder.
ExecuteResult execute(const Experiment& experiment, const std::vector<Topic>& topics,
                      const ExecuteRequest& request);

/// A finished run of the same hash, newest first; absent when there is none.
std::optional<std::filesystem::path> find_run(const Experiment& experiment);

}  // namespace geoprior
