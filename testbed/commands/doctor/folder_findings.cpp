#include <unistd.h>

#include <array>
#include <filesystem>

#include "core/error.h"
#include "testbed/commands/doctor/findings.h"
#include "testbed/formats/folders.h"
#include "testbed/home.h"
#include "testbed/runner/run_folder.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

/// The model of the main job, and those of other experiments; scripts/convert_data.sh makes them.
constexpr const char* kMainModel = "human.glb";
constexpr std::array<const char*, 6> kOtherModels{"animation_with_skeleton.glb",
                                                  "bcn_epileptic.glb",
                                                  "bear.off",
                                                  "bunny.off",
                                                  "dinosaur.off",
                                                  "diplodocus.off"};
const std::string kGetModels = "in a clone scripts/setup.sh; the package geoprior has them";

Finding home_finding() {
  Finding home{.what = "home folder",
               .required = true,
               .needed_for = "experiment files, models, scripts of plots and reports",
               .get = "set GEOPRIOR_HOME to a clone, or install the package geoprior"};
  try {
    home.where = geoprior_home().string();
    home.found = true;
  } catch (const Error& error) {
    home.where = error.what();
  }
  return home;
}

Finding main_model(const fs::path& data) {
  std::error_code ignored;
  const fs::path file = data / kMainModel;
  return {"model " + std::string(kMainModel),   true,
          fs::is_regular_file(file, ignored),   file.string(),
          "skinning/knee and other characters", kGetModels};
}

Finding other_models(const fs::path& data) {
  std::string missing;
  for (const char* name : kOtherModels) {
    std::error_code ignored;
    if (fs::is_regular_file(data / name, ignored)) continue;
    missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  return {"other models",
          false,
          missing.empty(),
          missing.empty() ? data.string() : "not in " + data.string() + ": " + missing,
          "experiments on models of others",
          kGetModels};
}

/// Makes a folder there, which goes again with all that was made for it: what permissions say is
/// not what a file system does.
Finding runs_finding() {
  Finding runs{.what = "folder of runs",
               .required = true,
               .needed_for = "what `run` writes without --out",
               .get = "set GEOPRIOR_RUNS to a folder that you may write"};
  try {
    const fs::path folder = fs::absolute(runs_root());
    runs.where = folder.string();
    const MadeFolders tried(folder / (".doctor-" + std::to_string(::getpid())));
    runs.found = true;
  } catch (const Error& error) {
    runs.where = error.what();
  }
  return runs;
}

}  // namespace

std::vector<Finding> folder_findings() {
  std::vector<Finding> findings{home_finding()};
  if (findings.front().found) {
    const fs::path data = geoprior_home() / "data";
    findings.push_back(main_model(data));
    findings.push_back(other_models(data));
  }
  findings.push_back(runs_finding());
  return findings;
}

}  // namespace geoprior
