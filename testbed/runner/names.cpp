#include "testbed/runner/names.h"

#include <algorithm>
#include <functional>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/streams.h"

namespace geoprior {

namespace {

constexpr std::string_view kPlainCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
constexpr std::string_view kFurtherCharacters = ".+=,";
constexpr std::size_t kLongestTextName = 200;
constexpr std::size_t kLongestQuote = 60;
/// Of a file of a frame behind the name of its part: "_00012.vtp".
constexpr std::size_t kLongestEnding = 32;

bool has_only(std::string_view text, std::string_view characters) {
  return text.find_first_not_of(characters) == std::string_view::npos;
}

bool is_name_character(char c) {
  return kPlainCharacters.find(c) != std::string_view::npos ||
         kFurtherCharacters.find(c) != std::string_view::npos;
}

bool has_name_length(std::string_view name) { return !name.empty() && name.size() <= kLongestName; }

bool is_line(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = printable_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string allowed_name(std::string_view characters) {
  return "1 to " + std::to_string(kLongestName) + " characters: letters, digits and " +
         std::string(characters);
}

Error no_name(std::string_view name, const std::string& what, const std::string& where,
              const std::string& allowed) {
  const std::string length =
      name.size() > kLongestName ? " (" + std::to_string(name.size()) + " characters)" : "";
  return Error(quoted_name(name) + length + " is no name of " + what, where, allowed);
}

}  // namespace

std::string quoted_name(std::string_view text) {
  std::string out = "'";
  while (!text.empty() && out.size() <= kLongestQuote) {
    const std::size_t length = printable_length(text);
    if (length > 0) {
      out += text.substr(0, length);
    } else {
      out += escaped_bytes(text.substr(0, 1));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out + (text.empty() ? "'" : "…'");
}

bool is_file_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName + kLongestEnding && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), is_name_character) && !is_temporary_file(name);
}

bool is_name(std::string_view name) { return has_name_length(name) && is_file_name(name); }

bool is_plain_name(std::string_view name) {
  return has_name_length(name) && has_only(name, kPlainCharacters);
}

void require_name(std::string_view name, const std::string& what, const std::string& where) {
  if (!is_name(name))
    throw no_name(name, what, where, allowed_name("_ - . + = , (no dot in front)"));
}

void require_plain_name(std::string_view name, const std::string& what, const std::string& where) {
  if (!is_plain_name(name)) throw no_name(name, what, where, allowed_name("- _"));
}

void require_text_name(std::string_view name, const std::string& what, const std::string& where) {
  if (name.empty() || name.size() > kLongestTextName || !is_line(name)) {
    throw no_name(name, what, where,
                  "1 to " + std::to_string(kLongestTextName) + " bytes of text on one line");
  }
}

void require_line(std::string_view text, const std::string& what, const std::string& where) {
  if (is_line(text)) return;
  throw Error("the text of " + what + " is no line: " + quoted_name(text), where,
              "UTF-8 without line breaks and control characters");
}

bool is_experiment_id(std::string_view id) {
  const std::size_t slash = id.find('/');
  return slash != std::string_view::npos && is_name(id.substr(0, slash)) &&
         is_name(id.substr(slash + 1));
}

void require_experiment_id(std::string_view id, const std::string& where) {
  if (is_experiment_id(id)) return;
  throw Error(
      quoted_name(id) + " is no identifier of an experiment", where,
      "two names, \"<topic>/<name>\", each of " + allowed_name("_ - . + = , (no dot in front)"));
}

std::string with_name_characters(std::string_view text) {
  std::string name(text);
  std::replace_if(name.begin(), name.end(), std::not_fn(is_name_character), '-');
  return name;
}

std::string name_from(std::string_view text) {
  std::string name = with_name_characters(text.substr(0, kLongestName));
  if (name.empty() || name.front() == '.') name.replace(0, 1, "-");
  if (is_temporary_file(name)) name.back() = '-';
  return name;
}

}  // namespace geoprior
