#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "testbed/commands/doctor/findings.h"
#include "testbed/view/child_process.h"
#include "testbed/view/python.h"

namespace geoprior {
namespace {

constexpr const char* kDebianPython = "/usr/bin/python3";

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

/// Of the `python3` that a shell starts, and an experiment whose command says no more.
constexpr std::array<PythonModule, 2> kModulesInPath{
    {{"numpy", false, "programs that `geoprior new external` writes; examples/external"},
     {"scipy", false, "poisson-scatter and others of examples/external"}}};

/// An interpreter, with the versions of the modules that it has.
struct Python {
  std::string program;
  std::map<std::string, std::string> versions;

  [[nodiscard]] bool has(const std::string& module) const { return versions.contains(module); }
};

/// A module that is there but broken is missing. What the script prints arrives on its stderr.
std::optional<Python> ask_python(const std::vector<std::string>& start,
                                 std::span<const PythonModule> modules) {
  std::string names;
  for (const PythonModule& module : modules) names += std::string(" ") + module.name;
  const std::string script =
      "import importlib, sys\n"
      "for name in '''" +
      names +
      "'''.split():\n"
      "    try: version = getattr(importlib.import_module(name), '__version__', '?')\n"
      "    except Exception: continue\n"
      "    print('has', name, version, file=sys.stderr)\n"
      "print('has python', sys.version.split()[0], file=sys.stderr)\n";
  std::vector<std::string> command = start;
  command.insert(command.end(), {"-c", script});
  const ChildResult answer = run_child(command, python_environment());
  if (answer.exit_code != 0) return std::nullopt;
  Python python{start.front(), {}};
  std::istringstream lines(answer.errors);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string has, name, version;
    if (words >> has >> name >> version && has == "has") python.versions[name] = version;
  }
  if (!python.has("python")) return std::nullopt;
  return python;
}

bool has_what_is_required(const Python& python) {
  return std::all_of(kModules.begin(), kModules.end(), [&](const PythonModule& module) {
    return !module.required || python.has(module.name);
  });
}

/// The one that plots are made with: the first that has all of it; else the first that runs.
std::optional<Python> chosen_python() {
  std::optional<Python> first;
  for (const std::string& program : python_candidates()) {
    const auto python = ask_python({program, "-B", "-E"}, kModules);
    if (python && has_what_is_required(*python)) return python;
    if (!first) first = python;
  }
  return first;
}

/// Packages of Debian are for its own Python alone.
std::string how_to_get(const std::string& module, const std::string& program,
                       const std::string& other_way) {
  std::error_code ignored;
  const std::string install = "apt-get install python3-" + module;
  if (std::filesystem::equivalent(program, kDebianPython, ignored)) return install;
  return "get " + module + " for " + program + ", or " + other_way + " (" + kDebianPython + ": " +
         install + ")";
}

std::vector<Finding> findings_of(const std::optional<Python>& python, const std::string& name,
                                 std::span<const PythonModule> modules,
                                 const std::string& other_way) {
  std::vector<Finding> findings;
  for (const PythonModule& module : modules) {
    Finding finding{.what = name + " " + module.name,
                    .required = module.required,
                    .found = python && python->has(module.name),
                    .where = "no python3",
                    .needed_for = module.needed_for,
                    .get = "a python3 that runs comes first"};
    if (python) {
      finding.where =
          finding.found ? python->versions.at(module.name) : "not in " + python->program;
      finding.get = how_to_get(module.name, python->program, other_way);
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

/// The interpreter itself.
Finding interpreter_finding(const std::optional<Python>& python) {
  std::string tried;
  for (const std::string& program : python_candidates()) {
    tried += (tried.empty() ? "" : ", ") + program;
  }
  const bool is_chosen = python_candidates().size() == 1;
  return {"python3",
          true,
          python.has_value(),
          python ? python->program + ", " + python->versions.at("python") : "tried " + tried,
          "plots, summary and report",
          is_chosen ? "set GEOPRIOR_PYTHON to a Python that runs, or unset it"
                    : "apt-get install python3, or set GEOPRIOR_PYTHON to an interpreter"};
}

}  // namespace

std::vector<Finding> python_findings() {
  const std::optional<Python> python = chosen_python();
  std::vector<Finding> findings{interpreter_finding(python)};
  std::optional<Python> in_path;
  if (const auto program = find_program("python3")) {
    in_path = ask_python({*program, "-B"}, kModulesInPath);
  }
  for (const auto& more :
       {findings_of(python, "python3", kModules, "set GEOPRIOR_PYTHON to another"),
        findings_of(in_path, "python3 in PATH,", kModulesInPath,
                    "put one that has it first in PATH")}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  return findings;
}

}  // namespace geoprior
