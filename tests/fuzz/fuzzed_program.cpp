#include "tests/fuzz/fuzzed_program.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "experiments/toy/toy_topic.h"
#include "tests/testbed/program_process.h"

namespace geoprior::test {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLimitMemory = false;  // the sanitizer maps terabytes
#else
constexpr bool kLimitMemory = true;
#endif

void limit(decltype(RLIMIT_AS) resource, rlim_t value) {
  const rlimit both{value, value};
  ::setrlimit(resource, &both);
}

std::vector<Topic> fuzzed_topics() {
  std::vector<Topic> topics = all_topics();
  for (Topic& topic : toy::topics()) topics.push_back(std::move(topic));
  return topics;
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 32 && c != '\n' && c != '\t') || byte == 127;
}

/// Of the lines of an error, "error: " begins one: the last.
Fault fault_of_error(const std::string& text) {
  std::istringstream in(text);
  std::size_t errors = 0;
  std::string line, last;
  while (std::getline(in, line)) {
    if (line.starts_with("error: ")) ++errors;
    last = line;
  }
  if (errors != 1 || !last.starts_with("error: ")) return {"exit code 2 without one line why", ""};
  constexpr std::size_t kLongest = 2000;
  if (last.size() > kLongest) return {"a very long error", std::to_string(last.size()) + " bytes"};
  return {};
}

}  // namespace

void enter(const std::filesystem::path& home) {
  ::setenv("GEOPRIOR_HOME", home.c_str(), 1);
  ::unsetenv("GEOPRIOR_RUNS");
  std::filesystem::current_path(home);
}

int fuzzed_program(const std::filesystem::path& home, const std::vector<std::string>& arguments) {
  enter(home);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, rlim_t{64} << 20);
  if (kLimitMemory) limit(RLIMIT_AS, rlim_t{6} << 30);
  return run_as_program(arguments, fuzzed_topics());
}

Fault fault_of(const CommandEnd& end) {
  if (end.hung) return {"hangs", ""};
  if (end.interrupted && end.code == -SIGINT) return {};
  if (end.code < 0) return {"died of a signal", std::to_string(-end.code)};
  if (end.code > 2) return {"exit code", std::to_string(end.code)};
  if (std::any_of(end.text.begin(), end.text.end(), is_control)) return {"control characters", ""};
  static const std::regex kDump(
      "Traceback|terminate called|HDF5-DIAG|ERROR: In |std::|bad_alloc|internal error|"
      "\\b0x[0-9a-fA-F]{6,}");
  std::smatch dump;
  if (std::regex_search(end.text, dump, kDump)) return {"words for developers", dump.str()};
  return end.code == 2 && !end.interrupted ? fault_of_error(end.text) : Fault{};
}

}  // namespace geoprior::test
