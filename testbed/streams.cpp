#include "testbed/streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>

#include "testbed/formats/atomic_file.h"

namespace geoprior {
namespace {

/// Length of the escape sequence of a colour ("\033[31;1m") that the text begins with, else 0.
std::size_t colour_length(std::string_view text) {
  if (!text.starts_with("\033[")) return 0;
  const std::size_t end = text.find_first_not_of("0123456789;", 2);
  return end != std::string_view::npos && text[end] == 'm' ? end + 1 : 0;
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

/// C0 without line end and tab, DEL, and C1 (U+0080 to U+009F).
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  if (character.size() == 2)
    return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
  return character.size() == 1 &&
         (first == 0x7F || (first < 0x20 && first != '\n' && first != '\t'));
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

std::string printable(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t colour = colour_length(text);
    const std::size_t character = character_length(text);
    const std::string_view next = text.substr(0, std::max({colour, character, std::size_t{1}}));
    const bool is_shown = colour > 0 || (character > 0 && !is_control(next));
    out += is_shown ? std::string(next) : escaped_bytes(next);
    text.remove_prefix(next.size());
  }
  return out;
}

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
  const std::string text = printable(line) + '\n';
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void print_out(std::string_view text) { write_all(STDOUT_FILENO, text, "standard output"); }

}  // namespace geoprior
