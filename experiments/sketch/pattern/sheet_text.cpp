#include "experiments/sketch/pattern/sheet_text.h"

#include <array>
#include <cstdint>

namespace geoprior::sketch {
namespace {

constexpr char32_t kReplacementCharacter = 0xFFFD;

/// Widths of the characters 32 to 126, in thousandths of the size.
constexpr std::array<int, 95> kHelveticaWidths{
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};

/// The next code point and how many bytes it takes; kReplacementCharacter and 1 for what is no
/// UTF-8.
std::pair<char32_t, std::size_t> next_code_point(std::string_view utf8) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(utf8[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || utf8.size() < length) return {kReplacementCharacter, 1};
  char32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {kReplacementCharacter, 1};
    code = (code << 6) | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  if (code < kLeast[length]) return {kReplacementCharacter, 1};
  return {code, length};
}

char32_t fit_for_label(char32_t c) {
  if (c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x2028 || c == 0x2029) return U' ';
  const bool turns = (c >= 0x200B && c <= 0x200F) || (c >= 0x202A && c <= 0x202E) ||
                     (c >= 0x2060 && c <= 0x206F) || c == 0xFEFF;
  const bool none = (c >= 0xD800 && c <= 0xDFFF) || (c & 0xFFFE) == 0xFFFE || c > 0x10FFFF ||
                    (c >= 0xFDD0 && c <= 0xFDEF);
  return turns || none ? kReplacementCharacter : c;
}

}  // namespace

std::u32string label_text(std::string_view utf8, std::size_t most) {
  std::u32string text;
  while (!utf8.empty()) {
    const auto [code, length] = next_code_point(utf8);
    utf8.remove_prefix(length);
    if (text.size() == most) {
      text.replace(most - 3, 3, U"...");
      break;
    }
    text.push_back(fit_for_label(code));
  }
  return text;
}

double helvetica_width(std::u32string_view text) {
  double width = 0;
  for (const char32_t c : text) {
    if (c >= 32 && c < 127) {
      width += kHelveticaWidths[c - 32];
    } else {
      width += c < 0x1100 ? 722 : 1000;
    }
  }
  return width / 1000;
}

}  // namespace geoprior::sketch
