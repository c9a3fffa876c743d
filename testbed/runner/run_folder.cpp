#include "testbed/runner/run_folder.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <optional>
#include <vector>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/system_reason.h"
#include "testbed/home.h"
#include "testbed/runner/inputs/run_reference.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/names.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/json.h"
#include "testbed/streams.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kShortHash = 8;

std::string utc_text(const char* format) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[40];
  std::strftime(text, sizeof text, format, &parts);
  return text;
}

std::string short_hash(const Experiment& experiment) {
  return experiment.hash.substr(0, kShortHash);
}

/// Folders of an experiment whose names hold `text`, newest first (names begin with the time).
std::vector<fs::path> folders_of(const std::string& experiment_id, const std::string& text) {
  std::vector<fs::path> folders;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(runs_root() / experiment_id, code)) {
    const std::string name = entry.path().filename().string();
    if (name.find(text) != std::string::npos) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end(), std::greater<>());
  return folders;
}

std::vector<fs::path> folders_of(const Experiment& experiment) {
  return folders_of(experiment.id, "-" + short_hash(experiment));
}

bool fits(const fs::path& folder, const std::function<bool(const RunRecord&)>& wanted) {
  try {
    return recorded_result(folder) && wanted(OpenedRun(folder).record());
  } catch (const Error&) {
    return false;
  }
}

bool is_finished(const fs::path& folder, const std::string& hash) {
  return fs::exists(folder / "run.h5") && recorded_result(folder) && recorded_hash(folder) == hash;
}

/// What a killed program can leave before its run begins: temporary files, and the file by which
/// earlier versions tried whether a folder is writable.
bool is_leftover(const fs::path& name) { return is_temporary_file(name) || name == "probe"; }

bool is_empty_or_absent(const fs::path& folder) {
  if (!fs::exists(folder)) return true;
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const auto& entry) { return is_leftover(entry.path().filename()); });
}

/// A folder can be unwritable although it exists: better now than after an hour. The file that
/// tries it has no name of anybody's, and none at all after this.
void require_writable(const fs::path& folder) {
  std::string file = (folder / "XXXXXX").string() + std::string(kTemporarySuffix);
  const int descriptor = ::mkostemps(file.data(), static_cast<int>(kTemporarySuffix.size()), 0);
  if (descriptor < 0) {
    throw Error("no file can be made in the output folder: " + system_reason(errno),
                folder.string());
  }
  ::unlink(file.c_str());
  ::close(descriptor);
}

/// Whether no other file began the run: a copy of the file elsewhere has other inputs beside it.
bool is_begun_by(const Experiment& experiment, const fs::path& folder) {
  const auto head = journal::read_head(folder / "journal.jsonl");
  return !head || head->experiment_file.empty() ||
         head->experiment_file == input_name(experiment.file);
}

fs::path folder_to_resume(const Experiment& experiment, const ExecuteRequest& request) {
  if (request.out) {
    if (!fs::exists(*request.out / "journal.jsonl")) {
      throw Error("is no run that could be resumed: it has no journal.jsonl", request.out->string(),
                  "the folder of a run; without --resume a new one begins there");
    }
    return *request.out;
  }
  for (const fs::path& folder : folders_of(experiment)) {
    if (is_begun_by(experiment, folder)) return folder;
  }
  throw Error("there is no run of '" + experiment.id + "' with this specification to resume",
              (runs_root() / experiment.id).string(), "a run without --resume");
}

/// Whether the run is of this very file, and every input is what it was when the run read it. A
/// copy of the file elsewhere has other inputs beside it. Runs that were inputs have their
/// specification in the hash.
bool is_run_of(const Experiment& experiment, const fs::path& folder) {
  try {
    const OpenedRun run(folder);
    const RunRecord& record = run.record();
    const auto file = record.provenance.find("experiment_file");
    if (file == record.provenance.end() || file->second != input_name(experiment.file)) {
      return false;
    }
    for (const StoredFile& input : record.inputs) {
      if (is_run_reference(input.name)) continue;
      if (sha256_of_file(input_file(input.name)) != input.sha256) return false;
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Experiments that need nothing of a clone run without one.
std::optional<fs::path> home_if_any() {
  try {
    return geoprior_home();
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool holds_text(const fs::path& file, const std::string& text) {
  return read_whole_file(file) == text;
}

}  // namespace

void require_own_beginning(const Experiment& experiment, const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    if (is_leftover(name) || name == "journal.jsonl") continue;
    const bool ours =
        fs::is_regular_file(entry.symlink_status()) &&
        ((name == "spec.toml" && holds_text(entry.path(), experiment.resolved_toml)) ||
         (name == "spec.json" && holds_text(entry.path(), spec_json(experiment))));
    if (ours) continue;
    throw Error("the journal is empty, and " + quoted_name(name.string()) +
                    " is not what this run begins with: it cannot be resumed",
                folder.string(), "a new folder, without --resume");
  }
}

std::string input_name(const fs::path& file) {
  const fs::path full = fs::weakly_canonical(file);
  const std::optional<fs::path> home = home_if_any();
  if (!home) return printable(full.string());
  const fs::path relative = full.lexically_relative(fs::weakly_canonical(*home));
  const bool is_outside = relative.empty() || *relative.begin() == "..";
  return printable((is_outside ? full : relative).string());
}

fs::path input_file(const std::string& name) {
  const fs::path file = geoprior_home() / name;
  return fs::exists(file) ? file : geoprior_home() / from_printable(name);
}

fs::path runs_root() {
  if (const char* folder = std::getenv("GEOPRIOR_RUNS"); folder != nullptr && *folder != '\0') {
    return folder;
  }
  return writable_home() / "results" / "runs";
}

fs::path unused_run_folder(const std::string& experiment_id, const std::string& hash) {
  const fs::path parent = runs_root() / experiment_id;
  const std::string name = utc_text("%Y%m%dT%H%M%SZ") + "-" + hash.substr(0, kShortHash);
  fs::path folder = parent / name;
  for (int n = 2; fs::exists(folder); ++n) folder = parent / (name + "-" + std::to_string(n));
  return folder;
}

std::string utc_now() { return utc_text("%Y-%m-%dT%H:%M:%SZ"); }

RunFolder open_run_folder(const Experiment& experiment, const ExecuteRequest& request) {
  RunFolder opened;
  fs::path& folder = opened.path;
  try {
    if (request.resume) {
      folder = folder_to_resume(experiment, request);
    } else {
      folder = request.out ? *request.out : unused_run_folder(experiment.id, experiment.hash);
      if (fs::exists(folder) && !fs::is_directory(folder)) {
        throw Error("is no folder", folder.string(), "a folder that is new or empty");
      }
      if (!is_empty_or_absent(folder)) {
        throw Error("is there already and not empty: a run is never overwritten", folder.string(),
                    "a new folder, or --resume to go on with this run");
      }
    }
    opened.made = MadeFolders(folder);
  } catch (const fs::filesystem_error& error) {
    throw Error("cannot be used as output folder: " + system_reason(error.code().value()),
                folder.string());
  }
  folder = fs::canonical(folder);
  if (!is_finished(folder, experiment.hash)) require_writable(folder);
  return opened;
}

std::optional<fs::path> find_run(const Experiment& experiment) {
  for (const fs::path& folder : folders_of(experiment)) {
    if (is_finished(folder, experiment.hash) && is_run_of(experiment, folder)) return folder;
  }
  return std::nullopt;
}

std::optional<fs::path> find_run_where(const std::string& experiment_id,
                                       const std::function<bool(const RunRecord&)>& wanted) {
  for (const fs::path& folder : folders_of(experiment_id, "-")) {
    if (fits(folder, wanted)) return folder;
  }
  return std::nullopt;
}

fs::path find_run_of_content(const std::string& experiment_id, const std::string& content_sha256) {
  const auto found = find_run_where(experiment_id, [&](const RunRecord& record) {
    return record.content_sha256 == content_sha256;
  });
  if (found) return *found;
  throw Error("the run of '" + experiment_id + "' with content " +
                  content_sha256.substr(0, kShortHash) + " is no longer there",
              (runs_root() / experiment_id).string(), "geoprior run " + experiment_id);
}

std::optional<fs::path> find_unfinished_run(const Experiment& experiment) {
  for (const fs::path& folder : folders_of(experiment)) {
    if (!recorded_result(folder) && fs::exists(folder / "journal.jsonl") &&
        is_begun_by(experiment, folder)) {
      return folder;
    }
  }
  return std::nullopt;
}

}  // namespace geoprior
