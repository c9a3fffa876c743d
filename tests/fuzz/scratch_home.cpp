#include "tests/fuzz/scratch_home.h"

#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.h"
#include "tests/testbed/scratch_place.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of_file(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

void add(const fs::directory_entry& entry, const fs::path& root, Files& files) {
  const std::string name = entry.path().lexically_relative(root).string();
  if (entry.is_symlink()) {
    files[name] = "-> " + fs::read_symlink(entry.path()).string();
  } else if (entry.is_regular_file()) {
    files[name] = bytes_of_file(entry.path());
  } else {
    files[name + "/"];
  }
}

}  // namespace

Files read_files(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) add(entry, folder, files);
  }
  return files;
}

ScratchHome::ScratchHome(const Files& files) {
  std::string pattern = (scratch_place() / "geoprior-fuzz-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw Error("no temporary folder", pattern);
  around_ = pattern;
  home_ = around_ / "some/way/down/home";
  for (const char* folder : {"experiments", "data", "results/runs", "results/reference"}) {
    fs::create_directories(home_ / folder);
  }
  for (const auto& [name, bytes] : files) {
    fs::create_directories((home_ / name).parent_path());
    std::ofstream(home_ / name, std::ios::binary) << bytes;
  }
  before_ = outside_results();
}

ScratchHome::~ScratchHome() {
  std::error_code ignored;
  fs::remove_all(around_, ignored);
}

std::optional<std::string> ScratchHome::change_outside_results() const {
  const Files after = outside_results();
  const auto [was, is] = std::mismatch(before_.begin(), before_.end(), after.begin(), after.end());
  if (was == before_.end() && is == after.end()) return std::nullopt;
  const bool gone = is == after.end() || (was != before_.end() && was->first < is->first);
  return gone ? was->first : is->first;
}

std::optional<std::string> ScratchHome::empty_run_folder() const {
  for (fs::recursive_directory_iterator it(home_ / "results/runs"), end; it != end; ++it) {
    if (!it->is_directory()) continue;
    if (fs::is_empty(*it)) return it->path().lexically_relative(home_).string();
    if (fs::exists(it->path() / "journal.jsonl")) it.disable_recursion_pending();
  }
  return std::nullopt;
}

Files ScratchHome::outside_results() const {
  Files files;
  for (fs::recursive_directory_iterator it(around_), end; it != end; ++it) {
    if (it->path() == output()) continue;
    if (it->path() == home_ / "results") {
      it.disable_recursion_pending();
    } else {
      add(*it, around_, files);
    }
  }
  return files;
}

}  // namespace geoprior::test
