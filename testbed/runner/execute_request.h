#pragma once

#include <filesystem>
#include <functional>
#include <optional>

namespace geoprior {

#ifdef NDEBUG
inline constexpr bool kIsDebugBuild = false;
#else
inline constexpr bool kIsDebugBuild = true;
#endif

/// How an experiment is run.
struct ExecuteRequest {
  std::optional<std::filesystem::path>
      out;  ///< --out; absent: results/runs/<id>/<timestamp>-<short hash>
  bool resume = false;
  bool show_progress = false;  ///< bar on stderr
  bool timing = true;          ///< run the benchmark after the frames
  /// A diagnostic that the topic's table lacks is an error (of tests, checks and debug builds);
  /// otherwise it is recorded without a unit.
  bool only_declared = kIsDebugBuild;
  /// Variants may start programs (docs/security.md); otherwise such an experiment is refused.
  bool allow_commands = false;
  bool grade = false;  ///< grade the claims (judgement/grades.h), of frames read back
  /// What the program says of the run's folder before a stop request ends it at once, while nothing
  /// is written (`LeaveAtOnce`); absent: it stops at the next consistent state only.
  std::function<void(const std::filesystem::path& folder)> farewell;
};

}  // namespace geoprior
