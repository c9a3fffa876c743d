#include "testbed/home.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

#include "core/error.h"
#include "testbed/formats/input_file.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

bool is_home(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "experiments", ignored) &&
         fs::is_directory(folder / "results", ignored);
}

/// A clone has the two folders above build/<preset>/geoprior.
std::optional<fs::path> home_above(fs::path folder) {
  for (;; folder = folder.parent_path()) {
    if (is_home(folder)) return folder;
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

}  // namespace

fs::path geoprior_home() {
  if (const char* chosen = std::getenv("GEOPRIOR_HOME"); chosen != nullptr && *chosen != '\0') {
    if (!is_home(chosen)) {
      throw Error("no folder with experiments/ and results/ in it",
                  "GEOPRIOR_HOME=" + std::string(chosen), "the clone");
    }
    return fs::absolute(chosen).lexically_normal();
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const auto home = error ? std::nullopt : home_above(program.parent_path());
  if (!home) {
    throw Error("no folder above it has experiments/ and results/", program.string(),
                "set the environment variable GEOPRIOR_HOME to the clone");
  }
  return *home;
}

fs::path find_file(const std::string& name, const fs::path& folder, const fs::path& of_clone,
                   const std::string& where) {
  std::string tried;
  for (const fs::path& base : {folder, geoprior_home() / of_clone}) {
    const fs::path candidate = (base / name).lexically_normal();
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate;
    const bool may_be_elsewhere =
        !fs::exists(candidate, ignored) || fs::is_directory(candidate, ignored);
    if (!may_be_elsewhere) require_regular_file(candidate);
    tried += (tried.empty() ? "" : ", ") + candidate.string();
  }
  throw Error("no file '" + name + "'", where, "looked for " + tried);
}

fs::path find_folder(const std::string& name, const fs::path& folder, const fs::path& of_clone,
                     const std::string& where) {
  std::string tried;
  for (const fs::path& base : {folder, geoprior_home() / of_clone}) {
    const fs::path candidate = (base / name).lexically_normal();
    std::error_code ignored;
    if (fs::is_directory(candidate, ignored)) return candidate;
    if (fs::exists(candidate, ignored)) {
      throw Error("is no folder: '" + candidate.string() + "'", where, "a folder");
    }
    tried += (tried.empty() ? "" : ", ") + candidate.string();
  }
  throw Error("no folder '" + name + "'", where, "looked for " + tried);
}

}  // namespace geoprior
