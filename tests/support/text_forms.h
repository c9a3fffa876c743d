#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace geoprior::test {

inline constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

/// A text with other line ends than \n.
inline std::string with_line_ends(std::string_view text, std::string_view end) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') {
      out += end;
    } else {
      out += c;
    }
  }
  return out;
}

struct TextForm {
  const char* name;
  std::string bytes;
};

/// The forms in which editors of several systems leave one text, itself first.
inline std::vector<TextForm> text_forms(const std::string& text) {
  return {{"plain", text},
          {"byte order mark", kByteOrderMark + text},
          {"CRLF", with_line_ends(text, "\r\n")},
          {"CR", with_line_ends(text, "\r")},
          {"byte order mark and CRLF", kByteOrderMark + with_line_ends(text, "\r\n")}};
}

/// ASCII as UTF-16 of the lower byte first, with its byte order mark.
inline std::string in_utf16(std::string_view text) {
  std::string out = "\xFF\xFE";
  for (const char c : text) {
    out += c;
    out += '\0';
  }
  return out;
}

}  // namespace geoprior::test
