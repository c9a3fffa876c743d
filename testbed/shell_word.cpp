#include "testbed/shell_word.h"

#include "testbed/streams.h"

namespace geoprior {
namespace {

/// Quotes of bash in which every byte can be written as something that a terminal shows.
std::string ansi_c_word(const std::string& word) {
  std::string escaped;
  for (const char c : word) {
    if (c == '\n') {
      escaped += "\\n";
    } else if (c == '\t') {
      escaped += "\\t";
    } else {
      if (c == '\'' || c == '\\') escaped += '\\';
      escaped += c;
    }
  }
  return "$'" + printable(escaped) + "'";
}

}  // namespace

std::string shell_word(const std::string& word) {
  const std::string plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  if (printable(word) != word || word.find_first_of("\n\t") != std::string::npos) {
    return ansi_c_word(word);
  }
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
