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

/// GEOPRIOR_HOME, else what the running program belongs to.
Home current_home() {
  if (const char* chosen = std::getenv("GEOPRIOR_HOME"); chosen != nullptr && *chosen != '\0') {
    if (!is_home(chosen)) {
      throw Error("no folder with experiments/ and results/ in it",
                  "GEOPRIOR_HOME=" + std::string(chosen), "the clone");
    }
    return {fs::absolute(chosen).lexically_normal()};
  }
  return home_of(fs::read_symlink("/proc/self/exe"));
}

/// The folder for a user's data, as the XDG base directory specification has it: a path that is
/// not absolute counts as none.
fs::path user_data_folder() {
  if (const char* chosen = std::getenv("XDG_DATA_HOME"); chosen != nullptr && *chosen == '/') {
    return chosen;
  }
  if (const char* user = std::getenv("HOME"); user != nullptr && *user == '/') {
    return fs::path(user) / ".local" / "share";
  }
  throw Error("there is no folder for what is written: HOME is not set", "an installed program",
              "set HOME, XDG_DATA_HOME or GEOPRIOR_RUNS to a folder");
}

}  // namespace

Home home_of(const fs::path& program) {
  const fs::path shared = program.parent_path().parent_path() / "share" / "geoprior";
  if (is_home(shared)) return {shared, true};
  if (const auto clone = home_above(program.parent_path())) return {*clone};
  throw Error("no folder above it has experiments/ and results/", program.string(),
              "set the environment variable GEOPRIOR_HOME to the clone");
}

fs::path geoprior_home() { return current_home().folder; }

fs::path writable_home() {
  const Home home = current_home();
  return home.installed ? user_data_folder() / "geoprior" : home.folder;
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
