#include "testbed/streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <utility>

#include "testbed/formats/atomic_file.h"

namespace geoprior {
namespace {

/// The escape sequences of `tinted`; others can hide what they stand before.
constexpr std::array<std::string_view, 5> kColours{"\033[0m", "\033[1m", "\033[2m", "\033[32m",
                                                   "\033[31;1m"};

/// Length of the colour that the text begins with, else 0.
std::size_t colour_length(std::string_view text) {
  const auto found = std::find_if(kColours.begin(), kColours.end(),
                                  [&](std::string_view one) { return text.starts_with(one); });
  return found == kColours.end() ? 0 : found->size();
}

/// Bytes of the UTF-8 character that the text begins with, 0 where there is none (Unicode 15,
/// table 3-7: no overlong forms, no surrogates).
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) return 0;
  unsigned char low = 0x80, high = 0xBF;
  if (byte(0) == 0xE0) low = 0xA0;
  if (byte(0) == 0xED) high = 0x9F;
  if (byte(0) == 0xF0) low = 0x90;
  if (byte(0) == 0xF4) high = 0x8F;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

/// The code point of a whole UTF-8 character.
unsigned code_point(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0);
  unsigned code = byte(0) & (0xFFU >> (character.size() + 1));
  for (std::size_t i = 1; i < character.size(); ++i) code = (code << 6U) | (byte(i) & 0x3FU);
  return code;
}

/// What a terminal obeys instead of showing it: control characters (C0 without line end and tab,
/// DEL, C1), Unicode's Bidi_Control, which let a text look like another, and its own ends of lines
/// and paragraphs.
bool is_control(std::string_view character) {
  constexpr std::array<std::pair<unsigned, unsigned>, 7> kControls{{{0x00, 0x08},
                                                                    {0x0B, 0x1F},
                                                                    {0x7F, 0x9F},
                                                                    {0x61C, 0x61C},
                                                                    {0x200E, 0x200F},
                                                                    {0x2028, 0x202E},
                                                                    {0x2066, 0x2069}}};
  const unsigned code = code_point(character);
  return std::any_of(kControls.begin(), kControls.end(), [&](const auto& range) {
    return code >= range.first && code <= range.second;
  });
}

std::string made_visible(std::string_view text, bool with_colours) {
  std::string out;
  while (!text.empty()) {
    const std::size_t colour = with_colours ? colour_length(text) : 0;
    const std::size_t character = character_length(text);
    const std::string_view next = text.substr(0, std::max({colour, character, std::size_t{1}}));
    const bool is_shown = colour > 0 || (character > 0 && !is_control(next));
    out += is_shown ? std::string(next) : escaped_bytes(next);
    text.remove_prefix(next.size());
  }
  return out;
}

}  // namespace

void reserve_standard_streams() {
  constexpr std::array<int, 3> kModes{O_RDONLY, O_RDONLY, O_WRONLY};
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // `open` takes the lowest free descriptor: this one, as those below are taken.
    if (::open("/dev/null", kModes[stream]) != stream) ::_exit(2);
  }
}

std::string escaped_bytes(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    std::array<char, 8> code{};
    std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned char>(byte));
    text += code.data();
  }
  return text;
}

std::size_t printable_length(std::string_view text) {
  const std::size_t length = character_length(text);
  const bool is_shown =
      length > 0 && !is_control(text.substr(0, length)) && text[0] != '\n' && text[0] != '\t';
  return is_shown ? length : 0;
}

std::string printable(std::string_view text) { return made_visible(text, false); }

std::string from_printable(std::string_view text) {
  std::string bytes;
  while (!text.empty()) {
    unsigned value = 0;
    const char* digits = text.data() + 2;
    const bool is_code = text.starts_with("\\x") && text.size() >= 4 &&
                         std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2;
    bytes += is_code ? static_cast<char>(value) : text.front();
    text.remove_prefix(is_code ? 4 : 1);
  }
  return bytes;
}

void say(std::string_view line) {
  const std::string text = made_visible(line, true) + '\n';
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void print_out(std::string_view text) { write_all(STDOUT_FILENO, text, "standard output"); }

}  // namespace geoprior
