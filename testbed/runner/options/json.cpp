#include "testbed/runner/options/json.h"

#include <algorithm>
#include <cctype>

#include "testbed/runner/number_text.h"

namespace geoprior {

using Json = nlohmann::ordered_json;

OptionJsonWriter::OptionJsonWriter() : root_(Json::object()), table_(&root_) {}

Json& OptionJsonWriter::member(std::string_view key) { return (*table_)[std::string(key)]; }

Json OptionJsonWriter::walk(const std::function<void()>& inside) {
  Json nested = Json::object();
  Json* const outer = table_;
  table_ = &nested;
  inside();
  table_ = outer;
  return nested;
}

void OptionJsonWriter::visit_value(std::string_view key, const OptionReference& x,
                                   const OptionInfo&) {
  std::visit(
      [&](const auto* value) {
        if constexpr (requires { value->has_value(); }) {
          member(key) = *value ? Json(**value) : Json(nullptr);
        } else {
          member(key) = *value;
        }
      },
      x);
}

void OptionJsonWriter::choice(std::string_view key, int& index,
                              std::span<const std::string_view> names, const OptionInfo&) {
  member(key) = std::string(names[index]);
}

void OptionJsonWriter::optional_choice(std::string_view key, std::optional<int>& index,
                                       std::span<const std::string_view> names, const OptionInfo&) {
  member(key) = index ? Json(std::string(names[*index])) : Json(nullptr);
}

void OptionJsonWriter::group(std::string_view key, const OptionInfo&,
                             const std::function<void()>& inside) {
  member(key) = walk(inside);
}

void OptionJsonWriter::optional_group(std::string_view key, bool& present, const OptionInfo&,
                                      const std::function<void()>& inside) {
  // `false` rather than null: a group that is present by default can be switched off by it.
  if (present)
    member(key) = walk(inside);
  else
    member(key) = false;
}

void OptionJsonWriter::list(std::string_view key, std::size_t count, const OptionInfo&,
                            const std::function<void(std::size_t)>&,
                            const std::function<void(std::size_t)>& inside) {
  Json items = Json::array();
  for (std::size_t i = 0; i < count; ++i) items.push_back(walk([&] { inside(i); }));
  member(key) = items;
}

namespace {

bool is_table_list(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_object(); });
}

/// A value on one line.
std::string inline_text(const Json& value) {
  if (value.is_number_float()) {
    std::string number = number_text(value.get<double>());
    const bool real = number.find_first_of(".en") != std::string::npos;
    return real ? number : number + ".0";
  }
  if (value.is_array()) {
    std::string text = "[";
    for (const Json& item : value) text += (text.size() > 1 ? ", " : "") + inline_text(item);
    return text + "]";
  }
  if (value.is_object()) {
    std::string text = "{";
    for (const auto& [key, item] : value.items()) {
      if (item.is_null()) continue;
      text += (text.size() > 1 ? ", " : " ") + toml_key(key) + " = " + inline_text(item);
    }
    return text + (text.size() > 1 ? " }" : "}");
  }
  return value.is_string() ? toml_string(value.get<std::string>()) : value.dump();
}

void write_table(const Json& table, const std::string& path, std::string& out) {
  for (const auto& [key, value] : table.items()) {
    if (value.is_null() || value.is_object() || is_table_list(value)) continue;
    out += toml_key(key) + " = " + inline_text(value) + "\n";
  }
  for (const auto& [key, value] : table.items()) {
    const std::string name = path.empty() ? toml_key(key) : path + "." + toml_key(key);
    if (value.is_object()) {
      out += "\n[" + name + "]\n";
      write_table(value, name, out);
    } else if (is_table_list(value)) {
      for (const Json& item : value) {
        out += "\n[[" + name + "]]\n";
        write_table(item, name, out);
      }
    }
  }
}

}  // namespace

std::string toml_key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  return bare ? key : toml_string(key);
}

std::string toml_string(const std::string& text) {
  // JSON's escapes are all escapes of TOML's basic strings; DEL is escaped by TOML alone.
  std::string quoted;
  for (const char c : Json(text).dump()) quoted += c == '\x7f' ? "\\u007f" : std::string(1, c);
  return quoted;
}

std::string toml_text(const Json& object) {
  std::string text;
  write_table(object, "", text);
  return text;
}

}  // namespace geoprior
