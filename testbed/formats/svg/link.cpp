#include "testbed/formats/svg/link.h"

#include <array>
#include <cstdint>
#include <system_error>

#include "core/error.h"
#include "testbed/formats/folders.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

/// Value of a hexadecimal digit, or -1.
int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// A '%' without two digits stands for itself: links are written by hand too.
std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
    const int low = high < 0 ? -1 : hexadecimal(text[i + 2]);
    decoded += low < 0 ? text[i] : static_cast<char>(high * 16 + low);
    if (low >= 0) i += 2;
  }
  return decoded;
}

/// Values of base64's characters; 64 for others.
std::array<std::uint8_t, 256> base64_values() {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::uint8_t, 256> values{};
  values.fill(64);
  for (std::size_t i = 0; i < kLetters.size(); ++i)
    values[static_cast<unsigned char>(kLetters[i])] = static_cast<std::uint8_t>(i);
  return values;
}

std::string base64_decoded(std::string_view text, const std::string& where) {
  static const std::array<std::uint8_t, 256> values = base64_values();
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    if (c == '=') break;
    const std::uint8_t value = values[static_cast<unsigned char>(c)];
    if (value == 64) throw Error("the data of the link is no base64", where, "A-Z a-z 0-9 + / =");
    bits = bits << 6 | value;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

/// "http", "file", … or nothing. One letter is a drive, which lies in no folder either.
std::string_view scheme_of(std::string_view href) {
  const std::size_t end = href.find_first_of(":/?#");
  return end == std::string_view::npos || href[end] != ':' ? std::string_view()
                                                           : href.substr(0, end);
}

}  // namespace

bool is_data_link(std::string_view href) { return href.starts_with("data:"); }

SvgData parse_data_link(std::string_view href, const std::string& where) {
  const std::size_t comma = href.find(',');
  if (!is_data_link(href) || comma == std::string_view::npos)
    throw Error("the link holds no data", where, "data:image/png;base64,…");
  const std::string_view head = href.substr(5, comma - 5);
  const std::string_view content = href.substr(comma + 1);
  SvgData data;
  data.media_type = head.substr(0, head.find(';'));
  data.bytes =
      head.ends_with(";base64") ? base64_decoded(content, where) : percent_decoded(content);
  return data;
}

fs::path file_of_link(std::string_view href, const fs::path& folder, const std::string& where) {
  const std::string quoted = "the link to '" + std::string(href.substr(0, 200)) + "'";
  const std::string allowed = "a file in the folder of the drawing, or below it";
  const std::string_view scheme = scheme_of(href);
  if (!scheme.empty() && scheme != "file") {
    throw Error(quoted + " leads out of the folder: '" + std::string(scheme) + ":' is not read",
                where, allowed);
  }
  std::string text = percent_decoded(href);
  if (text.find('\0') != std::string::npos) throw Error(quoted + " is no path", where, allowed);
  if (!scheme.empty()) text.erase(0, text.starts_with("file://") ? 7 : 5);
  fs::path path = fs::path(text).lexically_normal();
  const fs::path home = folder.empty() ? fs::path(".") : folder;
  if (path.is_absolute()) path = path.lexically_relative(fs::absolute(home).lexically_normal());
  if (path.empty() || *path.begin() == ".." || *path.begin() == "." || path.is_absolute())
    throw Error(quoted + " leads out of the folder", where, allowed);
  try {
    return path_below(home, path);
  } catch (const Error& e) {
    throw Error(quoted + ": " + e.what(), where, allowed);
  }
}

}  // namespace geoprior
