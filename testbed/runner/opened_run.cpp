#include "testbed/runner/opened_run.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/error.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/vtk/files.h"
#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/streams.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRunFile = "run.h5";
constexpr const char* kAllowed =
    "the folder of a finished run as it was written; compare, render, video, report and export "
    "have --force";

/// More than a line of kind `result` has.
constexpr std::streamoff kTail = 4096;

/// Without its line break; empty for an empty or missing journal, and for a line beyond the tail.
std::string last_line(const fs::path& run_folder) {
  const fs::path file = path_below(run_folder, "journal.jsonl");
  if (!fs::is_regular_file(file)) return {};
  std::ifstream in(file, std::ios::binary);
  if (!in.seekg(0, std::ios::end)) return {};
  in.seekg(-std::min<std::streamoff>(kTail, in.tellg()), std::ios::end);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!text.ends_with('\n')) return {};  // torn: the run was interrupted
  text.pop_back();
  const std::size_t before = text.rfind('\n');
  return before == std::string::npos ? std::string() : text.substr(before + 1);
}

}  // namespace

void require_recorded(const fs::path& file, const std::string& sha256) {
  if (sha256_of_file(file) != sha256) {
    throw Error("is damaged or another file: its SHA-256 is not the recorded one", file.string());
  }
}

std::optional<std::string> recorded_result(const fs::path& run_folder) {
  try {
    const journal::Line last = journal::from_text(last_line(run_folder));
    const auto* result = std::get_if<journal::ResultLine>(&last);
    return result == nullptr ? std::nullopt : std::optional(result->file.sha256);
  } catch (const Error&) {
    return std::nullopt;  // empty or damaged
  }
}

std::optional<std::string> recorded_hash(const fs::path& run_folder) {
  const auto head = journal::read_head(run_folder / "journal.jsonl");
  return head ? std::optional(head->spec_hash) : std::nullopt;
}

OpenedRun::OpenedRun(fs::path folder, RunRecord record)
    : folder_(std::move(folder)), record_(std::move(record)) {}

OpenedRun::OpenedRun(fs::path folder, Unverified unverified)
    : folder_(std::move(folder)), unverified_(unverified) {
  require_result();
  record_ = read_run_file(path_below(folder_, kRunFile));
}

void OpenedRun::require_result() const {
  const fs::path file = folder_ / kRunFile;
  if (const auto recorded = recorded_result(folder_)) {
    verify(file, *recorded);
  } else if (unverified_ == Unverified::refused) {
    throw Error("its checksum is not in the journal beside it", file.string(), kAllowed);
  } else {
    say("warning: --force: " + file.string() + " is read without a recorded checksum");
  }
}

Part OpenedRun::part(const StoredFile& stored) const {
  const fs::path path = file(stored);
  if (unverified_ == Unverified::refused) return read_vtk_part(path);
  std::optional<double> parameter;
  return read_foreign_vtk_part(path, parameter);
}

fs::path OpenedRun::file(const StoredFile& stored) const {
  fs::path path = path_below(folder_, stored.name);
  verify(path, stored.sha256);
  return path;
}

void OpenedRun::verify(const fs::path& file, const std::string& sha256) const {
  try {
    require_recorded(file, sha256);
  } catch (const Error& error) {
    if (unverified_ == Unverified::refused) {
      throw Error(error.what(), "", kAllowed);
    }
    say(std::string("warning: --force: ") + error.what());
  }
}

void require_recorded_frames(const OpenedRun& run, const VariantRecord& variant) {
  for (const FrameRecord& frame : variant.frames) {
    for (const StoredFile& file : frame.files) (void)run.file(file);
  }
}

void require_recorded_files(const OpenedRun& run) {
  for (const CaseRecord& one : run.record().cases) {
    for (const VariantRecord& variant : one.variants) {
      require_recorded_frames(run, variant);
      for (const StoredFile& file : variant.artifacts) (void)run.file(file);
    }
  }
}

}  // namespace geoprior
