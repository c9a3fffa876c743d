#include "testbed/runner/process/provenance.h"

#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "testbed/runner/process/build_info.h"

namespace geoprior {

namespace {

/// The value of a line "key : value" of /proc/cpuinfo or /proc/meminfo.
std::string proc_value(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t colon = line.find(':');
    const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "unknown";
}

std::string system_name() {
  utsname names{};
  if (::uname(&names) != 0) return "unknown";
  return std::string(names.sysname) + " " + names.release + " " + names.machine;
}

}  // namespace

std::map<std::string, std::string> provenance() {
  const BuildInfo& build = build_info();
  std::map<std::string, std::string> facts{
      {"version", build.version},
      {"git_commit", build.git_commit},
      {"git_dirty", build.git_dirty() ? "true" : "false"},
      {"git_difference", build.git_difference},
      {"compiler", build.compiler},
      {"build_type", build.build_type},
      {"flags", build.flags},
      {"instruction_set", build.instruction_set},
      {"cpu", proc_value("/proc/cpuinfo", "model name")},
      {"hardware_threads", std::to_string(std::thread::hardware_concurrency())},
      {"memory", proc_value("/proc/meminfo", "MemTotal")},
      {"system", system_name()},
  };
  for (const auto& [name, version] : build.libraries) facts["library_" + name] = version;
  return facts;
}

}  // namespace geoprior
