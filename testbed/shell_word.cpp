#include "testbed/shell_word.h"

#include "core/error.h"

namespace geoprior {
namespace {

/// Quotes of bash in which every byte can be written as something that a terminal shows.
std::string ansi_c_word(const std::string& word) {
  std::string escaped;
  for (const char c : word) escaped += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
  return "$'" + printable(escaped) + "'";
}

}  // namespace

std::string shell_word(const std::string& word) {
  const std::string plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  if (printable(word) != word) return ansi_c_word(word);
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
  return line;
}

}  // namespace geoprior
