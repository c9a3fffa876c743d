#include "testbed/runner/options/toml.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/error.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

std::string expected(std::string_view type, const OptionInfo& info) {
  const std::string range = range_text(info);
  return std::string(type) + (range.empty() ? "" : ", " + range);
}

template <class Item>
constexpr std::string_view plural_of() {
  if constexpr (std::is_same_v<Item, double>) return "numbers";
  if constexpr (std::is_same_v<Item, int>) return "integers";
  return "texts";
}

}  // namespace

std::string range_text(const OptionInfo& info) {
  const bool below = std::isfinite(info.min), above = std::isfinite(info.max);
  std::string text;
  if (below && above) {
    text = "between " + number_text(info.min) + " and " + number_text(info.max);
  } else if (below) {
    text = "at least " + number_text(info.min);
  } else if (above) {
    text = "at most " + number_text(info.max);
  }
  if (!text.empty() && !info.unit.empty()) text += " " + std::string(info.unit);
  return text;
}

OptionTomlReader::OptionTomlReader(const TomlNode& table, std::string path) {
  if (table.kind != TomlNode::Kind::table) {
    throw Error("is " + table.kind_name(), table.place + ": " + path, "a table");
  }
  levels_.push_back({&table, std::move(path), {}});
}

void OptionTomlReader::finish() const { require_all_known(levels_.front()); }

void OptionTomlReader::require_all_known(const Level& level) {
  for (std::size_t i = 0; i < level.table->keys.size(); ++i) {
    const std::string& key = level.table->keys[i];
    if (std::find(level.known.begin(), level.known.end(), key) != level.known.end()) continue;
    const std::string path = level.path.empty() ? key : level.path + "." + key;
    throw Error("unknown key", level.table->items[i].place + ": " + path,
                allowed_names(key, level.known));
  }
}

std::string OptionTomlReader::path_of(std::string_view key) const {
  const std::string& path = levels_.back().path;
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string OptionTomlReader::where(const TomlNode& node, std::string_view key) const {
  return node.place + ": " + path_of(key);
}

const TomlNode* OptionTomlReader::take(std::string_view key, const OptionInfo& info) {
  levels_.back().known.emplace_back(key);
  const TomlNode* node = levels_.back().table->find(key);
  if (node == nullptr && info.required) {
    const TomlNode& table = *levels_.back().table;
    const std::string near = nearest_name(key, table.keys);
    throw Error("is missing" + (near.empty() ? "" : "; is '" + near + "' meant?"),
                where(table, key), std::string(info.doc));
  }
  return node;
}

double OptionTomlReader::number(const TomlNode& node, std::string_view key,
                                const OptionInfo& info) const {
  double x = 0;
  if (node.kind == TomlNode::Kind::real) {
    x = node.real;
  } else if (node.kind == TomlNode::Kind::integer) {
    x = static_cast<double>(node.integer);
  } else {
    throw Error("is " + node.kind_name(), where(node, key), expected("a number", info));
  }
  if (!std::isfinite(x)) {
    throw Error("is not finite", where(node, key), expected("a finite number", info));
  }
  if (x < info.min || x > info.max) {
    throw Error(number_text(x) + " is out of range", where(node, key), range_text(info));
  }
  return x;
}

int OptionTomlReader::integer(const TomlNode& node, std::string_view key,
                              const OptionInfo& info) const {
  if (node.kind != TomlNode::Kind::integer) {
    throw Error("is " + node.kind_name(), where(node, key), expected("an integer", info));
  }
  const double low = std::max(info.min, static_cast<double>(std::numeric_limits<int>::min()));
  const double high = std::min(info.max, static_cast<double>(std::numeric_limits<int>::max()));
  const auto x = static_cast<double>(node.integer);
  if (x < low || x > high) {
    OptionInfo limits = info;
    limits.min = low;
    limits.max = high;
    const bool of_option = std::isfinite(info.min) || std::isfinite(info.max);
    throw Error(std::to_string(node.integer) + " is out of range", where(node, key),
                range_text(of_option && x >= std::numeric_limits<int>::min() &&
                                   x <= std::numeric_limits<int>::max()
                               ? info
                               : limits));
  }
  return static_cast<int>(node.integer);
}

const std::string& OptionTomlReader::text(const TomlNode& node, std::string_view key,
                                          const OptionInfo& info) const {
  if (node.kind != TomlNode::Kind::text) {
    throw Error("is " + node.kind_name(), where(node, key), expected("a text in quotes", info));
  }
  return node.text;
}

const TomlNode& OptionTomlReader::array(const TomlNode& node, std::string_view key,
                                        std::string_view of,
                                        std::optional<std::size_t> size) const {
  const std::string what =
      "an array of " + (size ? std::to_string(*size) + " " : std::string()) + std::string(of);
  if (node.kind != TomlNode::Kind::array) {
    throw Error("is " + node.kind_name(), where(node, key), what);
  }
  if (size && node.items.size() != *size) {
    throw Error("has " + std::to_string(node.items.size()) + " elements", where(node, key), what);
  }
  return node;
}

template <class T>
T OptionTomlReader::read(const TomlNode& node, std::string_view key, const OptionInfo& info) const {
  if constexpr (std::is_same_v<T, double>) {
    return number(node, key, info);
  } else if constexpr (std::is_same_v<T, int>) {
    return integer(node, key, info);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return text(node, key, info);
  } else if constexpr (std::is_same_v<T, bool>) {
    if (node.kind == TomlNode::Kind::boolean) return node.boolean;
    throw Error("is " + node.kind_name(), where(node, key), "true or false");
  } else if constexpr (requires(T x) { x.has_value(); }) {
    return read<typename T::value_type>(node, key, info);
  } else if constexpr (requires(T x) { x.push_back({}); }) {
    using Item = typename T::value_type;
    T items;
    for (const TomlNode& item : array(node, key, plural_of<Item>()).items) {
      items.push_back(read<Item>(item, key, info));
    }
    return items;
  } else {
    using Item = typename T::value_type;
    T items{};
    const TomlNode& all = array(node, key, plural_of<Item>(), items.size());
    for (std::size_t i = 0; i < items.size(); ++i) items[i] = read<Item>(all.items[i], key, info);
    return items;
  }
}

void OptionTomlReader::visit_value(std::string_view key, const OptionReference& x,
                                   const OptionInfo& info) {
  const TomlNode* node = take(key, info);
  if (node == nullptr) return;
  std::visit(
      [&](auto* value) { *value = read<std::remove_pointer_t<decltype(value)>>(*node, key, info); },
      x);
}

void OptionTomlReader::choice(std::string_view key, int& index,
                              std::span<const std::string_view> names, const OptionInfo& info) {
  std::optional<int> chosen = index;
  optional_choice(key, chosen, names, info);
  index = *chosen;
}

void OptionTomlReader::optional_choice(std::string_view key, std::optional<int>& index,
                                       std::span<const std::string_view> names,
                                       const OptionInfo& info) {
  const TomlNode* node = take(key, info);
  if (node == nullptr) return;
  const std::vector<std::string> allowed(names.begin(), names.end());
  if (node->kind != TomlNode::Kind::text) {
    throw Error("is " + node->kind_name(), where(*node, key), allowed_names("", allowed));
  }
  const auto at = std::find(allowed.begin(), allowed.end(), node->text);
  if (at == allowed.end()) {
    throw Error("unknown choice '" + node->text + "'", where(*node, key),
                allowed_names(node->text, allowed));
  }
  index = static_cast<int>(at - allowed.begin());
}

void OptionTomlReader::walk(const TomlNode& table, std::string path,
                            const std::function<void()>& inside) {
  if (table.kind != TomlNode::Kind::table) {
    throw Error("is " + table.kind_name(), table.place + ": " + path, "a table");
  }
  levels_.push_back({&table, std::move(path), {}});
  inside();
  require_all_known(levels_.back());
  levels_.pop_back();
}

void OptionTomlReader::group(std::string_view key, const OptionInfo& info,
                             const std::function<void()>& inside) {
  const TomlNode* node = take(key, info);
  TomlNode empty;
  empty.place = levels_.back().table->place;
  // Members of an absent table are walked too: one of them may be required.
  walk(node != nullptr ? *node : empty, path_of(key), inside);
}

void OptionTomlReader::optional_group(std::string_view key, bool& present, const OptionInfo& info,
                                      const std::function<void()>& inside) {
  const TomlNode* node = take(key, info);
  if (node == nullptr) {
    if (present) {
      TomlNode empty;
      empty.place = levels_.back().table->place;
      walk(empty, path_of(key), inside);
    }
    return;
  }
  if (node->kind == TomlNode::Kind::boolean && !node->boolean) {
    present = false;
    return;
  }
  present = true;
  walk(*node, path_of(key), inside);
}

void OptionTomlReader::list(std::string_view key, std::size_t count, const OptionInfo& info,
                            const std::function<void(std::size_t)>& resize,
                            const std::function<void(std::size_t)>& inside) {
  (void)count;  // what the file gives replaces the default elements
  const TomlNode* node = take(key, info);
  if (node == nullptr) return;
  const TomlNode& tables = array(*node, key, "tables");
  resize(0);
  resize(tables.items.size());
  for (std::size_t i = 0; i < tables.items.size(); ++i) {
    walk(tables.items[i], path_of(key) + "." + std::to_string(i), [&] { inside(i); });
  }
}

}  // namespace geoprior
