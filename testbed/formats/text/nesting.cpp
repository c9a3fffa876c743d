#include "testbed/formats/text/nesting.h"

#include <algorithm>

#include "core/error.h"

namespace geoprior {
namespace {

std::string byte_place(const std::string& name, std::size_t at) {
  return name + ", byte " + std::to_string(at);
}

std::string line_place(std::string_view text, const std::string& name, std::size_t at) {
  const auto end = text.begin() + at;
  return name + ":" + std::to_string(1 + std::count(text.begin(), end, '\n'));
}

[[noreturn]] void fail_too_deep(const std::string& what, const std::string& place) {
  throw Error(what, place, "at most " + std::to_string(kMostNesting) + " levels");
}

/// Just past the next `mark` at or after `at`, or the end of the text.
std::size_t past(std::string_view text, std::string_view mark, std::size_t at) {
  const std::size_t found = text.find(mark, at);
  return found == std::string_view::npos ? text.size() : found + mark.size();
}

/// Just past the text that the quotes at `at` begin: of TOML three of them make a text of several
/// lines. Backslashes escape in double quotes only.
std::size_t past_quoted(std::string_view text, std::size_t at, bool triple_allowed) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool triple = triple_allowed && text.substr(at, 3) == three;
  const std::string_view mark = triple ? std::string_view(three) : text.substr(at, 1);
  for (at += mark.size(); at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;
    } else if (text.substr(at, mark.size()) == mark) {
      at += mark.size();
      // A text of several lines may end in one or two quotes of its own.
      for (int more = 0; triple && more < 2 && text.substr(at, 1) == mark.substr(0, 1); ++more)
        ++at;
      return at;
    } else if (triple_allowed && !triple && text[at] == '\n') {
      return at;  // not closed: the parser says so
    }
  }
  return text.size();
}

bool opens(char c) { return c == '[' || c == '{'; }
bool closes(char c) { return c == ']' || c == '}'; }

/// Past the tag that begins at `at`; attributes may hold a '>'. `closed` says that it ends in "/>".
std::size_t past_tag(std::string_view text, std::size_t at, bool& closed) {
  for (++at; at < text.size() && text[at] != '>'; ++at) {
    if (text[at] != '"' && text[at] != '\'') continue;
    at = text.find(text[at], at + 1);
    if (at == std::string_view::npos) return text.size();
  }
  closed = at < text.size() && text[at - 1] == '/';
  return std::min(at + 1, text.size());
}

}  // namespace

void require_shallow_json(std::string_view text, const std::string& name) {
  int depth = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '"') {
      at = past_quoted(text, at, false);
      continue;
    }
    if (opens(text[at]) && ++depth > kMostNesting) {
      fail_too_deep("brackets are nested too deep", byte_place(name, at));
    }
    if (closes(text[at])) --depth;
    ++at;
  }
}

void require_shallow_toml(std::string_view text, const std::string& name) {
  int depth = 0, dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = past_quoted(text, at, true);
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (opens(c) && ++depth > kMostNesting) {
      fail_too_deep("brackets are nested too deep", line_place(text, name, at));
    }
    if (closes(c)) --depth;
    // A key ends where something begins that no key has.
    if (opens(c) || closes(c) || c == '=' || c == ',' || c == '\n') dots = 0;
    if (c == '.' && ++dots >= kMostNesting) {
      fail_too_deep("a dotted key has too many parts", line_place(text, name, at));
    }
    ++at;
  }
}

void require_shallow_xml(std::string_view text, const std::string& name) {
  int depth = 0;
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = past(text, "-->", at);
    } else if (rest.starts_with("<![CDATA[")) {
      at = past(text, "]]>", at);
    } else if (rest.starts_with("<?")) {
      at = past(text, "?>", at);
    } else if (rest.starts_with("<!")) {
      at = past(text, ">", at);
    } else {
      const bool ends = rest.starts_with("</");
      bool closed = false;
      const std::size_t begin = at;
      at = past_tag(text, at, closed);
      if (ends) --depth;
      if (!ends && !closed && ++depth > kMostNesting) {
        fail_too_deep("elements are nested too deep", byte_place(name, begin));
      }
    }
  }
}

}  // namespace geoprior
