#include "solvers/embryo/triples/nesting.h"

#include <algorithm>
#include <cstddef>

#include "core/error.h"

namespace geoprior::embryo {

namespace {

std::string line_at(std::string_view bytes, std::size_t place, const std::string& where) {
  const auto line = 1 + std::ranges::count(bytes.substr(0, place), '\n');
  return where + ":" + std::to_string(line);
}

[[noreturn]] void refuse_depth(std::string_view bytes, std::size_t place, int limit,
                               const std::string& where) {
  throw Error("nested too deeply", line_at(bytes, place, where), std::to_string(limit) + " levels");
}

/// The place behind the next `end` from `from` on, or that of the end of the text.
std::size_t behind(std::string_view bytes, std::string_view end, std::size_t from) {
  const std::size_t found = bytes.find(end, from);
  return found == std::string_view::npos ? bytes.size() : found + end.size();
}

/// The place behind a text in quotes that begins at `from`; backslashes escape.
std::size_t behind_quoted(std::string_view bytes, std::size_t from) {
  const char quote = bytes[from];
  const std::string three(3, quote);
  const bool is_long = bytes.substr(from, 3) == three;
  for (std::size_t i = from + (is_long ? 3 : 1); i < bytes.size(); ++i) {
    if (bytes[i] == '\\') {
      ++i;
    } else if (is_long ? bytes.substr(i, 3) == three : bytes[i] == quote || bytes[i] == '\n') {
      return i + (is_long ? 3 : 1);
    }
  }
  return bytes.size();
}

/// The place behind a tag's '>', quoted attributes skipped.
std::size_t behind_tag(std::string_view bytes, std::size_t from) {
  for (std::size_t i = from; i < bytes.size(); ++i) {
    if (bytes[i] == '>') return i + 1;
    if (bytes[i] != '"' && bytes[i] != '\'') continue;
    i = behind(bytes, bytes.substr(i, 1), i + 1) - 1;
  }
  return bytes.size();
}

/// Declarations "<!ENTITY name SYSTEM …>" would open a file or an address.
void require_own_entities(std::string_view bytes, const std::string& where) {
  constexpr std::string_view kEntity = "<!ENTITY";
  for (std::size_t i = bytes.find(kEntity); i != std::string_view::npos;
       i = bytes.find(kEntity, i + 1)) {
    const std::size_t end =
        std::min({behind(bytes, ">", i), bytes.find('"', i), bytes.find('\'', i)});
    const std::string_view head = bytes.substr(i, end - i);
    if (head.find("SYSTEM") != std::string_view::npos ||
        head.find("PUBLIC") != std::string_view::npos)
      throw Error("an entity of another file", line_at(bytes, i, where), "entities with a value");
  }
}

}  // namespace

void require_shallow_turtle(std::string_view bytes, int limit, const std::string& where) {
  int depth = 0;
  for (std::size_t i = 0; i < bytes.size();) {
    switch (bytes[i]) {
      case '#':
        i = behind(bytes, "\n", i);
        break;
      // An IRI has no line break: one that does is malformed, and hides nothing behind it.
      case '<':
        i = std::min(behind(bytes, ">", i), behind(bytes, "\n", i));
        break;
      case '"':
      case '\'':
        i = behind_quoted(bytes, i);
        break;
      case '\\':
        i += 2;
        break;
      case '[':
      case '(':
        if (++depth > limit) refuse_depth(bytes, i, limit, where);
        ++i;
        break;
      case ']':
      case ')':
        --depth;
        ++i;
        break;
      default:
        ++i;
    }
  }
}

void require_shallow_xml(std::string_view bytes, int limit, const std::string& where) {
  require_own_entities(bytes, where);
  int depth = 0;
  for (std::size_t i = bytes.find('<'); i < bytes.size(); i = bytes.find('<', i)) {
    const std::string_view rest = bytes.substr(i);
    if (rest.starts_with("<!--")) {
      i = behind(bytes, "-->", i + 4);
    } else if (rest.starts_with("<![CDATA[")) {
      i = behind(bytes, "]]>", i);
    } else if (rest.starts_with("<?")) {
      i = behind(bytes, "?>", i);
    } else if (rest.starts_with("<!")) {
      i = i + 2;  // what a document type declares begins with '<' too
    } else if (rest.starts_with("</")) {
      --depth;
      i = behind_tag(bytes, i);
    } else {
      const std::size_t begin = i;
      i = behind_tag(bytes, i);
      const bool is_empty = i >= 2 && bytes[i - 2] == '/';
      if (!is_empty && ++depth > limit) refuse_depth(bytes, begin, limit, where);
    }
  }
}

}  // namespace geoprior::embryo
