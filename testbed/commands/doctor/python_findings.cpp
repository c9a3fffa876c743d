#include <array>
#include <map>
#include <sstream>

#include "testbed/commands/doctor/findings.h"
#include "testbed/view/child_process.h"
#include "testbed/view/python.h"

namespace geoprior {
namespace {

struct PythonModule {
  const char* name;
  bool required;
  const char* needed_for;
};

constexpr std::array<PythonModule, 5> kModules{
    {{"numpy", true, "plots, summary and report"},
     {"h5py", true, "plots, summary and report: reads run.h5"},
     {"matplotlib", true, "metrics.svg, times.svg, the report's plots"},
     {"rdflib", false, "`query`, and experiments that hold the ontology against rdflib"},
     {"pandas", false, "your own tables of run.h5 (docs/file-formats.md); nothing of ours"}}};

/// An interpreter, with the versions of the modules that it has.
struct Python {
  std::string program;
  std::map<std::string, std::string> versions;
};

/// A module that is there but broken is missing. What the script prints arrives on its stderr.
std::optional<Python> ask_python(const std::string& program) {
  std::string names;
  for (const PythonModule& module : kModules) names += std::string(" ") + module.name;
  const std::string script =
      "import importlib, sys\n"
      "for name in '''" +
      names +
      "'''.split():\n"
      "    try: version = getattr(importlib.import_module(name), '__version__', '?')\n"
      "    except Exception: continue\n"
      "    print('has', name, version, file=sys.stderr)\n"
      "print('has python', sys.version.split()[0], file=sys.stderr)\n";
  const ChildResult answer = run_child({program, "-B", "-E", "-c", script}, python_environment());
  if (answer.exit_code != 0) return std::nullopt;
  Python python{program, {}};
  std::istringstream lines(answer.errors);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string has, name, version;
    if (words >> has >> name >> version && has == "has") python.versions[name] = version;
  }
  return python;
}

bool has_what_is_required(const Python& python) {
  for (const PythonModule& module : kModules) {
    if (module.required && !python.versions.contains(module.name)) return false;
  }
  return true;
}

/// The one that plots are made with: the first that has all of it; else the first that runs.
std::optional<Python> chosen_python() {
  std::optional<Python> first;
  for (const std::string& program : python_candidates()) {
    const auto python = ask_python(program);
    if (python && has_what_is_required(*python)) return python;
    if (!first) first = python;
  }
  return first;
}

}  // namespace

std::vector<Finding> python_findings() {
  const std::optional<Python> python = chosen_python();
  std::string tried;
  for (const std::string& program : python_candidates()) {
    tried += (tried.empty() ? "" : ", ") + program;
  }
  std::vector<Finding> findings{
      {"python3", true, python.has_value(),
       python ? python->program + ", " + python->versions.at("python") : "tried " + tried,
       "plots, summary and report",
       "apt-get install python3, or set GEOPRIOR_PYTHON to an interpreter"}};
  for (const PythonModule& module : kModules) {
    const bool has = python && python->versions.contains(module.name);
    findings.push_back({"python3 " + std::string(module.name), module.required, has,
                        has      ? python->versions.at(module.name)
                        : python ? "not in " + python->program
                                 : "no python3",
                        module.needed_for, "apt-get install python3-" + std::string(module.name)});
  }
  return findings;
}

}  // namespace geoprior
