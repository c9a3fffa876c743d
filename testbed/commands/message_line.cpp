#include "testbed/commands/message_line.h"

#include <array>
#include <cstdio>

namespace geoprior {
namespace {

constexpr std::size_t kHead = 1000, kTail = 500;  // bytes

/// Bytes of the control character at the beginning of `text`: the C0 and DEL have one, the C1 in
/// UTF-8 two; 0 when there is another character.
std::size_t control_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x20 || byte(0) == 0x7f) return 1;
  return text.size() > 1 && byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0 ? 2 : 0;
}

void append_escaped(std::string& out, char c) {
  if (c == '\n') {
    out += "\\n";
  } else if (c == '\t') {
    out += "\\t";
  } else {
    std::array<char, 8> hex{};
    std::snprintf(hex.data(), hex.size(), "\\x%02x", static_cast<unsigned char>(c));
    out += hex.data();
  }
}

bool continues_a_character(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; }

std::string shortened(std::string text) {
  if (text.size() <= kHead + kTail) return text;
  std::size_t head = kHead, tail = text.size() - kTail;
  while (head > 0 && continues_a_character(text[head])) --head;
  while (tail < text.size() && continues_a_character(text[tail])) ++tail;
  return text.substr(0, head) + " […] " + text.substr(tail);
}

}  // namespace

std::string message_line(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t control = control_character(text);
    for (std::size_t i = 0; i < control; ++i) append_escaped(out, text[i]);
    if (control == 0) out += text.front();
    text.remove_prefix(control == 0 ? 1 : control);
  }
  return shortened(std::move(out));
}

}  // namespace geoprior
