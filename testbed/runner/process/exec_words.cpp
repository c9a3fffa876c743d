#include "testbed/runner/process/exec_words.h"

#include <unistd.h>

#include <string_view>

extern char** environ;  // NOLINT: POSIX

namespace geoprior {

std::vector<char*> null_terminated(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

std::vector<std::string> merged_environment(const std::vector<std::string>& added) {
  std::vector<std::string> out = added;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::string_view name = text.substr(0, text.find('=') + 1);
    bool replaced = false;
    for (const std::string& a : added) replaced = replaced || std::string_view(a).starts_with(name);
    if (!replaced) out.emplace_back(text);
  }
  return out;
}

}  // namespace geoprior
