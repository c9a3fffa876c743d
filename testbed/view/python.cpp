#include "testbed/view/python.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "testbed/home.h"
#include "testbed/streams.h"
#include "testbed/view/child_process.h"

namespace geoprior {
namespace {

const std::string kInstallPython =
    "apt-get install python3-h5py python3-matplotlib python3-numpy, or set GEOPRIOR_PYTHON to an "
    "interpreter that has h5py, matplotlib and numpy";

std::string find_python() {
  std::string tried;
  for (const std::string& python : python_candidates()) {
    const ChildResult test =
        run_child({python, "-E", "-c", "import h5py, matplotlib, numpy"}, python_environment());
    if (test.exit_code == 0) return python;
    tried += (tried.empty() ? "" : "; ") + python + ": " + test.reason();
  }
  throw Error("no Python with h5py, matplotlib and numpy (" + tried + ")", "plots and report",
              kInstallPython);
}

}  // namespace

std::vector<std::string> python_candidates() {
  const char* chosen = std::getenv("GEOPRIOR_PYTHON");
  if (chosen != nullptr && *chosen != '\0') return {chosen};
  return {"/usr/bin/python3", "python3"};
}

const std::vector<std::string>& python_environment() {
  static const std::vector<std::string> kAdded{"MPLBACKEND=Agg", "OPENBLAS_NUM_THREADS=1"};
  return kAdded;
}

void run_python(const std::string& script, const std::vector<std::string>& arguments) {
  const std::filesystem::path file = geoprior_home() / "results" / (script + ".py");
  if (!std::filesystem::exists(file)) throw Error("no such script", file.string());
  static const std::string python = find_python();
  // -B: no __pycache__ in the clone; -E: a foreign PYTHONPATH or PYTHONHOME does not matter.
  std::vector<std::string> command{python, "-B", "-E", file.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ChildResult result = run_child(command, python_environment());
  if (result.exit_code != 0) throw Error(result.reason(), script + ".py");
  const std::size_t end = result.errors.find_last_not_of('\n');
  if (end != std::string::npos) say(result.errors.substr(0, end + 1));
}

}  // namespace geoprior
