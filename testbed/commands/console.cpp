#include "testbed/commands/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace geoprior {
namespace {

bool on_terminal() {
  static const bool answer = isatty(STDERR_FILENO) == 1 && std::getenv("NO_COLOR") == nullptr;
  return answer;
}

/// Code points, not bytes: columns stay aligned with units such as "°".
std::size_t width(const std::string& text) {
  return std::count_if(text.begin(), text.end(),
                       [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
}

}  // namespace

std::string tinted(const std::string& text, Tint tint) {
  if (!on_terminal()) return text;
  const char* code = "1";
  if (tint == Tint::good) code = "32";
  if (tint == Tint::bad) code = "31;1";
  if (tint == Tint::faint) code = "2";
  return std::string("\033[") + code + "m" + text + "\033[0m";
}

void say_table(const std::vector<std::vector<std::string>>& rows, const std::string& indent) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      line += rows[r][i];
      if (i + 1 < rows[r].size()) line += std::string(widths[i] - width(rows[r][i]) + 2, ' ');
    }
    say(indent + (r == 0 ? tinted(line, Tint::strong) : line));
  }
}

void print_json(const nlohmann::ordered_json& json) {
  const auto text = [&](bool in_ascii) {
    return json.dump(2, ' ', in_ascii, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  };
  const std::string plain = text(false);
  print_out(printable(plain) == plain ? plain : text(true));  // the same that no terminal obeys
}

nlohmann::ordered_json json_number(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

}  // namespace geoprior
