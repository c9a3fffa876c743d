#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/topic.h"

namespace geoprior {

/// A finished run whose metrics this program computed, without running a method.
struct MeasuredRun {
  /// That of the run: frames, events, artifacts, diagnostics, times and memory are kept, metrics,
  /// summaries, studies and claims are new. `spec_hash` is its own, so that it is never taken for a
  /// run of this program; provenance keeps what made the frames and says, as `measured_…`, what
  /// measured them.
  RunRecord record;
  Experiment experiment;  ///< that the run was recorded with
};

/// Measures a finished run again: each scene is loaded as the run recorded it, each frame read
/// back. An unchanged program gives the same `metrics_sha256`.
///
/// @throws Error    naming a file of the run that is damaged, an input that is missing or another
///                  than the one recorded, or what of the run's experiment this program does not
///                  know
/// @throws Stopped  after Ctrl-C, between two frames
MeasuredRun measure_again(const OpenedRun& run, const std::vector<Topic>& topics);

/// Whether this very program measured the run.
bool is_measured_by_us(const RunRecord& record);

/// Writes a measured run into a folder of its own, whole or not at all. Frames and artifacts are
/// links to the files of the run that was measured (hard links; copies on another file system):
/// they stay when that folder goes.
///
/// @param out  new or empty; absent: below runs_root(), as a new run
/// @return     the folder
/// @throws Error    as open_run_folder
/// @throws Stopped  after Ctrl-C; nothing is left
std::filesystem::path write_measured_run(const MeasuredRun& measured, const OpenedRun& of,
                                         const std::optional<std::filesystem::path>& out);

/// How the metrics of two records of the same frames differ: names of the metric table.
struct MetricChanges {
  std::vector<std::string> added;
  std::vector<std::string> gone;
  std::vector<std::string> changed;  ///< in at least one value, by as little as a bit
};
MetricChanges metric_changes(const RunRecord& before, const RunRecord& now);

}  // namespace geoprior
