#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "testbed/formats/folders.h"
#include "testbed/runner/execute_request.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// Where runs go without --out: $GEOPRIOR_RUNS, else results/runs of writable_home().
std::filesystem::path runs_root();

/// Time of now in UTC, "2025-01-31T12:00:00Z".
std::string utc_now();

struct RunFolder {
  std::filesystem::path path;  ///< absolute, links resolved
  MadeFolders made;            ///< of these the folders that stay empty go again
};

/// Folder of a run that shall be written: makes a new one, or finds the one to go on with.
///
/// Without `resume` the folder must not exist or be empty. With `resume` and without `out` it is
/// the newest folder of the same hash below runs_root().
/// @throws Error  naming the folder and what is allowed; before anything is computed
RunFolder open_run_folder(const Experiment& experiment, const ExecuteRequest& request);

/// A folder below runs_root() that is not there yet: <id>/<time of now>-<beginning of the hash>.
std::filesystem::path unused_run_folder(const std::string& experiment_id, const std::string& hash);

/// A run writes its specification before the first line of its journal, and nothing else: only such
/// a folder may be gone on with while the journal is empty. What else is there is not ours to
/// replace or remove.
/// @throws Error  naming a file that is not of this beginning
void require_own_beginning(const Experiment& experiment, const std::filesystem::path& folder);

/// Name under which a run records an input file: relative to the clone where it lies inside, else
/// absolute; `printable`, as it goes into JSON.
std::string input_name(const std::filesystem::path& file);

/// The file that a run recorded under that name; it need not exist any more.
std::filesystem::path input_file(const std::string& name);

/// A finished run of the same hash, newest first; absent when there is none.
std::optional<std::filesystem::path> find_run(const Experiment& experiment);

/// The newest finished run of an experiment whose record is a wanted one; absent when there is
/// none.
std::optional<std::filesystem::path> find_run_where(
    const std::string& experiment_id, const std::function<bool(const RunRecord&)>& wanted);

/// The newest run of an experiment with that `content_sha256`.
/// @throws Error  when there is none below runs_root()
std::filesystem::path find_run_of_content(const std::string& experiment_id,
                                          const std::string& content_sha256);

/// The newest folder of the experiment that an interrupted run of the same hash left.
std::optional<std::filesystem::path> find_unfinished_run(const Experiment& experiment);

}  // namespace geoprior
