#include "testbed/runner/spec/toml_tree.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "testbed/formats/text/nesting.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/joined.h"
#include "testbed/streams.h"

namespace geoprior {
namespace {

std::string place_of(const toml::source_region& region, const std::string& source) {
  if (!region.begin) return source;
  return source + ":" + std::to_string(region.begin.line) + ":" +
         std::to_string(region.begin.column);
}

TomlNode convert(const toml::node& node, const std::string& place, const std::string& source) {
  TomlNode result;
  result.place = place;
  if (const auto* table = node.as_table()) {
    result.kind = TomlNode::Kind::table;
    std::vector<std::pair<const toml::key*, const toml::node*>> members;
    for (const auto& [key, value] : *table) members.emplace_back(&key, &value);
    std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) {
      const auto &p = a.first->source().begin, &q = b.first->source().begin;
      return p.line != q.line ? p.line < q.line : p.column < q.column;
    });
    for (const auto& [key, value] : members) {
      result.keys.emplace_back(key->str());
      result.items.push_back(convert(*value, place_of(key->source(), source), source));
    }
  } else if (const auto* array = node.as_array()) {
    result.kind = TomlNode::Kind::array;
    for (const toml::node& value : *array) {
      result.items.push_back(convert(value, place_of(value.source(), source), source));
    }
  } else if (const auto* boolean = node.as_boolean()) {
    result.kind = TomlNode::Kind::boolean;
    result.boolean = boolean->get();
  } else if (const auto* integer = node.as_integer()) {
    result.kind = TomlNode::Kind::integer;
    result.integer = integer->get();
  } else if (const auto* real = node.as_floating_point()) {
    result.kind = TomlNode::Kind::real;
    result.real = real->get();
  } else if (const auto* text = node.as_string()) {
    result.kind = TomlNode::Kind::text;
    result.text = text->get();
  } else {
    throw Error("dates and times have no meaning here", place,
                "a text, a number, true or false, an array, a table");
  }
  return result;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row[b.size()];
}

bool is_bare_word(const std::string& value) {
  const auto allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 ||
           std::string_view("_-./:+").find(static_cast<char>(c)) != std::string_view::npos;
  };
  return !value.empty() && std::all_of(value.begin(), value.end(), allowed);
}

}  // namespace

const TomlNode* TomlNode::find(std::string_view key) const {
  const auto at = std::find(keys.begin(), keys.end(), key);
  if (kind != Kind::table || at == keys.end()) return nullptr;
  return &items[at - keys.begin()];
}

TomlNode* TomlNode::find(std::string_view key) {
  return const_cast<TomlNode*>(static_cast<const TomlNode*>(this)->find(key));
}

void TomlNode::set(const std::string& key, TomlNode value) {
  if (TomlNode* existing = find(key)) {
    *existing = std::move(value);
    return;
  }
  keys.push_back(key);
  items.push_back(std::move(value));
}

void TomlNode::erase(std::string_view key) {
  const auto at = std::find(keys.begin(), keys.end(), key);
  if (at == keys.end()) return;
  items.erase(items.begin() + (at - keys.begin()));
  keys.erase(at);
}

std::string TomlNode::kind_name() const {
  switch (kind) {
    case Kind::boolean:
      return "a boolean";
    case Kind::integer:
      return "an integer";
    case Kind::real:
      return "a number";
    case Kind::text:
      return "a text";
    case Kind::array:
      return "an array";
    case Kind::table:
      return "a table";
  }
  return "a value";
}

TomlNode parse_toml_text(std::string_view text, const std::string& source) {
  require_shallow_toml(text, source);
  try {
    const toml::table table = toml::parse(text);
    return convert(table, source, source);
  } catch (const toml::parse_error& error) {
    throw Error(std::string(error.description()), place_of(error.source(), source));
  }
}

TomlNode parse_toml_file(const std::filesystem::path& file) {
  return parse_toml_text(read_text_file(file), file.string());
}

TomlNode parse_toml_value(const std::string& value, const std::string& source) {
  try {
    TomlNode parsed = parse_toml_text("value = " + value, source);
    if (parsed.items.size() == 1) {
      TomlNode& node = parsed.items.front();
      node.place = source;
      return std::move(node);
    }
  } catch (const Error&) {
    if (!is_bare_word(value)) throw Error("is no TOML value: " + value, source);
  }
  if (!is_bare_word(value)) throw Error("is no TOML value: " + value, source);
  if (printable(value) != value) throw Error("is no printable UTF-8: " + value, source);
  TomlNode word;
  word.kind = TomlNode::Kind::text;
  word.text = value;
  word.place = source;
  return word;
}

std::vector<std::string> split_dotted_key(const std::string& key, const std::string& place) {
  std::vector<std::string> parts(1);
  char quote = 0;
  for (const char c : key) {
    if (quote != 0) {
      if (c == quote)
        quote = 0;
      else
        parts.back() += c;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  if (quote != 0 || std::find(parts.begin(), parts.end(), "") != parts.end()) {
    throw Error("'" + key + "' is no dotted key", place, "names separated by dots, scene.a.b");
  }
  return parts;
}

void set_at(TomlNode& root, const std::vector<std::string>& parts, const TomlNode& value) {
  TomlNode* node = &root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string& part = parts[i];
    if (node->kind == TomlNode::Kind::array) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
      if (error != std::errc{} || end != part.data() + part.size() || index >= node->items.size()) {
        throw Error(
            "'" + part + "' is no element of the array", value.place,
            node->items.empty() ? "it is empty" : "0 to " + std::to_string(node->items.size() - 1));
      }
      node = &node->items[index];
    } else if (node->kind == TomlNode::Kind::table) {
      if (node->find(part) == nullptr) {
        TomlNode made;
        made.place = value.place;
        node->set(part, made);
      }
      node = node->find(part);
    } else {
      throw Error("'" + part + "' lies in " + node->kind_name(), value.place, "a table");
    }
  }
  *node = value;
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  std::string nearest;
  std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : names) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string allowed_names(std::string_view name, const std::vector<std::string>& names) {
  const std::string text = names.empty() ? "nothing here" : joined(names);
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? text : text + "; did you mean '" + nearest + "'?";
}

std::string place_of(const TomlNode& table, std::string_view key) {
  const TomlNode* member = table.find(key);
  return (member != nullptr ? *member : table).place + ": " + std::string(key);
}

}  // namespace geoprior
