#include "testbed/runner/run_folder.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <vector>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/home.h"
#include "testbed/runner/run_file.h"
#include "testbed/runner/run_inputs.h"
#include "testbed/runner/sha256.h"
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

bool has_content(const fs::path& folder, const std::string& content_sha256) {
  const fs::path file = folder / "run.h5";
  try {
    return fs::exists(file) && read_run_file(file).content_sha256 == content_sha256;
  } catch (const Error&) {
    return false;
  }
}

bool is_finished(const fs::path& folder, const std::string& hash) {
  try {
    return fs::exists(folder / "run.h5") && read_spec_hash(folder / "run.h5") == hash;
  } catch (const Error&) {
    return false;
  }
}

fs::path new_default_folder(const Experiment& experiment) {
  const fs::path parent = runs_root() / experiment.id;
  const std::string name = utc_text("%Y%m%dT%H%M%SZ") + "-" + short_hash(experiment);
  fs::path folder = parent / name;
  for (int n = 2; fs::exists(folder); ++n) folder = parent / (name + "-" + std::to_string(n));
  return folder;
}

bool is_empty_or_absent(const fs::path& folder) {
  return !fs::exists(folder) || (fs::is_directory(folder) && fs::is_empty(folder));
}

/// A folder can be unwritable although it exists: better now than after an hour.
void require_writable(const fs::path& folder) {
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error("the output folder is " + system_reason(errno), folder.string(),
                "a folder in which files can be made");
  }
  write_file_atomically(folder / "probe", std::string_view{});
  fs::remove(folder / "probe");
}

fs::path folder_to_resume(const Experiment& experiment, const ExecuteRequest& request) {
  if (request.out) {
    if (!fs::exists(*request.out / "journal.jsonl")) {
      throw Error("is no run that could be resumed: it has no journal.jsonl", request.out->string(),
                  "the folder of a run; without --resume a new one begins there");
    }
    return *request.out;
  }
  const std::vector<fs::path> folders = folders_of(experiment);
  if (folders.empty()) {
    throw Error("there is no run of '" + experiment.id + "' with this specification to resume",
                (runs_root() / experiment.id).string(), "a run without --resume");
  }
  return folders.front();
}

/// The file that a run recorded under `input_name`.
fs::path input_file(const std::string& name) {
  const fs::path file = geoprior_home() / name;
  return fs::exists(file) ? file : geoprior_home() / from_printable(name);
}

/// Whether every input file is what it was when the run read it. Runs that were inputs have their
/// specification in the hash.
bool has_unchanged_inputs(const fs::path& folder) {
  try {
    for (const StoredFile& input : read_run_file(folder / "run.h5").inputs) {
      if (is_run_reference(input.name)) continue;
      if (sha256_of_file(input_file(input.name)) != input.sha256) return false;
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string input_name(const fs::path& file) {
  const fs::path full = fs::weakly_canonical(file);
  const fs::path relative = full.lexically_relative(fs::weakly_canonical(geoprior_home()));
  const bool is_outside = relative.empty() || *relative.begin() == "..";
  return printable((is_outside ? full : relative).string());
}

fs::path runs_root() {
  if (const char* folder = std::getenv("GEOPRIOR_RUNS"); folder != nullptr && *folder != '\0') {
    return folder;
  }
  return geoprior_home() / "results" / "runs";
}

std::string utc_now() { return utc_text("%Y-%m-%dT%H:%M:%SZ"); }

fs::path open_run_folder(const Experiment& experiment, const ExecuteRequest& request) {
  fs::path folder;
  try {
    if (request.resume) {
      folder = folder_to_resume(experiment, request);
    } else {
      folder = request.out ? *request.out : new_default_folder(experiment);
      if (fs::exists(folder) && !fs::is_directory(folder)) {
        throw Error("is no folder", folder.string(), "a folder that is new or empty");
      }
      if (!is_empty_or_absent(folder)) {
        throw Error("is there already and not empty: a run is never overwritten", folder.string(),
                    "a new folder, or --resume to go on with this run");
      }
    }
    make_folders(fs::absolute(folder));
  } catch (const fs::filesystem_error& error) {
    throw Error("cannot be used as output folder: " + system_reason(error.code().value()),
                folder.string());
  }
  folder = fs::canonical(folder);
  if (!is_finished(folder, experiment.hash)) require_writable(folder);
  return folder;
}

std::optional<fs::path> find_run(const Experiment& experiment) {
  for (const fs::path& folder : folders_of(experiment)) {
    if (is_finished(folder, experiment.hash) && has_unchanged_inputs(folder)) return folder;
  }
  return std::nullopt;
}

fs::path find_run_of_content(const std::string& experiment_id, const std::string& content_sha256) {
  for (const fs::path& folder : folders_of(experiment_id, "-")) {
    if (has_content(folder, content_sha256)) return folder;
  }
  throw Error("the run of '" + experiment_id + "' with content " +
                  content_sha256.substr(0, kShortHash) + " is no longer there",
              (runs_root() / experiment_id).string(), "geoprior run " + experiment_id);
}

std::optional<fs::path> find_unfinished_run(const Experiment& experiment) {
  for (const fs::path& folder : folders_of(experiment)) {
    if (!fs::exists(folder / "run.h5") && fs::exists(folder / "journal.jsonl")) return folder;
  }
  return std::nullopt;
}

void remove_unlisted(const fs::path& run_folder, const fs::path& relative,
                     const std::set<std::string>& keep) {
  const fs::path folder = run_folder / relative;
  if (!fs::exists(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = (relative / entry.path().filename()).string();
    if (entry.is_regular_file() && !keep.contains(name)) fs::remove(entry.path());
  }
}

}  // namespace geoprior
