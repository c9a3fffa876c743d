#include "experiments/sketch/command/result_folder.h"

#include <system_error>
#include <utility>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/system_reason.h"

namespace geoprior::sketch {
namespace {

namespace fs = std::filesystem;

void require_unused(const fs::path& folder) {
  std::error_code code;
  if (!fs::exists(fs::symlink_status(folder, code))) return;
  if (!fs::is_directory(folder, code))
    throw Error("is no folder", folder.string(), "a folder that is new or empty");
  for (const fs::path& entry : sorted_entries(folder)) {
    if (is_temporary_file(entry)) continue;
    throw Error("is there already and not empty: a result is never overwritten", folder.string(),
                "a new or empty folder");
  }
}

void move_up(const fs::path& from, const fs::path& to) {
  std::error_code code;
  if (fs::exists(fs::symlink_status(to, code)))
    throw Error("has been written by another program meanwhile", to.string());
  fs::rename(from, to, code);
  if (code) throw Error("cannot be written: " + system_reason(code.value()), to.string());
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder) : folder_(std::move(folder)) {
  require_unused(folder_);
  made_.emplace(folder_);
  std::error_code code;
  for (int n = 1;; ++n) {
    unfinished_ = folder_ / ("unfinished-" + std::to_string(n) + std::string(kTemporarySuffix));
    if (fs::create_directory(unfinished_, code)) return;
    // What a killed program has left, or one that is at work in the same folder.
    if (!code) continue;
    const std::string reason = system_reason(code.value());
    made_.reset();
    throw Error("no folder can be made in it: " + reason, folder_.string());
  }
}

ResultFolder::~ResultFolder() { discard(); }

void ResultFolder::commit(const fs::path& last) {
  for (const fs::path& made : sorted_entries(unfinished_)) {
    if (made.filename() != last) move_up(made, folder_ / made.filename());
  }
  move_up(unfinished_ / last, folder_ / last);
}

void ResultFolder::discard() noexcept {
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
  made_.reset();
}

fs::path unused_result_folder(const fs::path& drawing) {
  const std::string name = drawing.stem().string() + "-sketch";
  fs::path folder = drawing.parent_path() / name;
  std::error_code ignored;
  for (int n = 2; fs::exists(fs::symlink_status(folder, ignored)); ++n)
    folder = drawing.parent_path() / (name + "-" + std::to_string(n));
  return folder;
}

}  // namespace geoprior::sketch
