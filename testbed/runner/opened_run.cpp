#include "testbed/runner/opened_run.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/error.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/journal.h"
#include "testbed/runner/sha256.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRunFile = "run.h5";
constexpr const char* kAllowed =
    "the folder of a finished run as it was written; render, video, report and export have --force";

/// More than a line of kind `result` has.
constexpr std::streamoff kTail = 4096;

std::ifstream open_journal(const fs::path& run_folder) {
  const fs::path file = run_folder / "journal.jsonl";
  return fs::is_regular_file(file) ? std::ifstream(file, std::ios::binary) : std::ifstream();
}

/// Without its line break; empty for an empty or missing journal, and for a line beyond the tail.
std::string last_line(const fs::path& run_folder) {
  std::ifstream in = open_journal(run_folder);
  if (!in.seekg(0, std::ios::end)) return {};
  in.seekg(-std::min<std::streamoff>(kTail, in.tellg()), std::ios::end);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!text.ends_with('\n')) return {};  // torn: the run was interrupted
  text.pop_back();
  const std::size_t before = text.rfind('\n');
  return before == std::string::npos ? std::string() : text.substr(before + 1);
}

/// A line of a journal as the kind T; absent when it is of another kind, or damaged.
template <class T>
std::optional<T> line_as(const std::string& text) {
  try {
    const journal::Line line = journal::from_text(text);
    const T* found = std::get_if<T>(&line);
    return found == nullptr ? std::nullopt : std::optional<T>(*found);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

void require_recorded(const fs::path& file, const std::string& sha256) {
  if (sha256_of_file(file) != sha256) {
    throw Error("is damaged or another file: its SHA-256 is not the recorded one", file.string());
  }
}

std::optional<std::string> recorded_result(const fs::path& run_folder) {
  const auto result = line_as<journal::ResultLine>(last_line(run_folder));
  return result ? std::optional(result->file.sha256) : std::nullopt;
}

std::optional<std::string> recorded_hash(const fs::path& run_folder) {
  std::ifstream in = open_journal(run_folder);
  std::string line;
  if (!std::getline(in, line)) return std::nullopt;
  const auto run = line_as<journal::RunLine>(line);
  return run ? std::optional(run->spec_hash) : std::nullopt;
}

OpenedRun::OpenedRun(fs::path folder, RunRecord record)
    : folder_(std::move(folder)), record_(std::move(record)) {}

OpenedRun::OpenedRun(fs::path folder, Unverified unverified)
    : folder_(std::move(folder)), unverified_(unverified) {
  require_result();
  record_ = read_run_file(folder_ / kRunFile);
}

void OpenedRun::require_result() const {
  const fs::path file = folder_ / kRunFile;
  if (const auto recorded = recorded_result(folder_)) {
    verify(file, *recorded);
  } else if (unverified_ == Unverified::refused) {
    throw Error("its checksum is not in the journal beside it", file.string(), kAllowed);
  } else {
    std::fprintf(stderr, "warning: --force: %s is read without a recorded checksum\n",
                 file.c_str());
  }
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
    std::fprintf(stderr, "warning: --force: %s\n", error.what());
  }
}

}  // namespace geoprior
