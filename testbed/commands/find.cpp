#include "testbed/commands/find.h"

#include <algorithm>

#include "core/error.h"
#include "testbed/catalogue.h"
#include "testbed/formats/folders.h"
#include "testbed/formats/input_file.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

/// Whether a name means a file and no identifier: by its ending, or by where it begins.
bool is_file_name(const std::string& name) {
  const fs::path path = name;
  return path.extension() == ".toml" || path.extension() == ".h5" || path.is_absolute() ||
         name.starts_with("./") || name.starts_with("../");
}

}  // namespace

fs::path experiment_file(const std::string& id_or_file) {
  if (fs::is_regular_file(id_or_file)) return id_or_file;
  if (fs::exists(id_or_file) && !fs::is_directory(id_or_file)) require_regular_file(id_or_file);
  if (is_file_name(id_or_file)) throw Error("no such file", id_or_file);
  if (const auto file = catalogued_file(id_or_file)) return *file;
  std::vector<std::string> ids;
  for (const CatalogueEntry& entry : catalogue()) ids.push_back(entry.id);
  throw Error("there is no experiment '" + id_or_file + "'", "", allowed_names(id_or_file, ids));
}

fs::path run_folder_of(const std::string& run) {
  const fs::path path = run;
  if (fs::is_regular_file(path) && path.filename() == "run.h5") {
    return fs::absolute(path).parent_path();
  }
  if (fs::is_directory(path)) {
    if (fs::is_regular_file(path / "run.h5")) return path;
    throw Error("has no run.h5", run, "the folder of a finished run; finish it with --resume");
  }
  if (fs::exists(path)) {
    throw Error("is no run", run, "a folder with run.h5, its run.h5, or an experiment");
  }
  std::vector<fs::path> runs;
  for (const fs::path& folder : sorted_entries(runs_root() / run)) {
    if (fs::is_regular_file(folder / "run.h5")) runs.push_back(folder);
  }
  // Runs that a check made have no picture: a run that somebody asked for comes first.
  const auto drawn = std::find_if(runs.rbegin(), runs.rend(), [](const fs::path& folder) {
    return fs::is_regular_file(folder / "figure.png");
  });
  if (drawn != runs.rend()) return *drawn;
  if (!runs.empty()) return runs.back();
  (void)experiment_file(run);
  throw Error("has no finished run", run, "geoprior run " + run);
}

}  // namespace geoprior
