#include "testbed/commands/message_line.h"

#include <algorithm>
#include <utility>

#include "testbed/streams.h"

namespace geoprior {
namespace {

constexpr std::size_t kHead = 1000, kTail = 500;  // bytes

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
    const std::size_t shown = printable_length(text);
    const std::string_view next = text.substr(0, std::max<std::size_t>(shown, 1));
    if (shown > 0) {
      out += next;
    } else if (next == "\n" || next == "\t") {
      out += next == "\n" ? "\\n" : "\\t";
    } else {
      out += escaped_bytes(next);
    }
    text.remove_prefix(next.size());
  }
  return shortened(std::move(out));
}

}  // namespace geoprior
