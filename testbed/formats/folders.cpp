#include "testbed/formats/folders.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"

namespace geoprior {

namespace fs = std::filesystem;

fs::path path_below(const fs::path& folder, const fs::path& relative) {
  fs::path path = folder;
  for (const fs::path& name : relative) {
    if (relative.is_absolute() || name == "..") {
      throw Error("leaves its folder: '" + relative.string() + "'", folder.string(),
                  "a path inside of it");
    }
    path /= name;
    std::error_code ignored;
    if (fs::is_symlink(fs::symlink_status(path, ignored))) {
      throw Error("is a symbolic link: none is followed here", path.string(), "files and folders");
    }
  }
  return path;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

MadeFolders::MadeFolders(const fs::path& folder) {
  std::error_code ignored;
  // A link to nothing is there: it is nothing that we made.
  for (fs::path missing = fs::absolute(folder); !fs::exists(fs::symlink_status(missing, ignored));
       missing = missing.parent_path()) {
    made_.insert(made_.begin(), missing);
  }
  try {
    make_folders(fs::absolute(folder));
  } catch (...) {
    remove_empty();
    throw;
  }
}

MadeFolders::~MadeFolders() { remove_empty(); }

MadeFolders& MadeFolders::operator=(MadeFolders&& other) noexcept {
  std::swap(made_, other.made_);
  return *this;
}

void MadeFolders::remove_empty() {
  std::error_code stays;
  std::for_each(made_.rbegin(), made_.rend(),
                [&](const fs::path& folder) { fs::remove(folder, stays); });
}

}  // namespace geoprior
