#include "testbed/runner/comparison/specification.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "testbed/joined.h"
#include "testbed/runner/spec/json.h"

namespace geoprior {
namespace {

using Differences = std::vector<KeyDifference>;

bool is_table(const TomlNode& node) { return node.kind == TomlNode::Kind::table; }

bool holds_tables(const TomlNode& node) {
  return node.kind == TomlNode::Kind::array && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(), is_table);
}

/// What a table of an array is called: one that is put before it is no change of its own.
std::string label_of(const TomlNode& item, std::size_t index) {
  for (const char* key : {"name", "text", "key"}) {
    const TomlNode* label = item.find(key);
    if (label != nullptr && label->kind == TomlNode::Kind::text) return label->text;
  }
  return std::to_string(index);
}

/// An array of tables as a table: "variant" with the members "implicit", "dual-quaternion". Of a
/// name that comes again the second is "name #2".
TomlNode by_label(const TomlNode& array) {
  TomlNode table;
  for (std::size_t i = 0; i < array.items.size(); ++i) {
    const std::string label = label_of(array.items[i], i);
    std::string unused = label;
    for (int n = 2; table.find(unused) != nullptr; ++n) unused = label + " #" + std::to_string(n);
    table.set(unused, array.items[i]);
  }
  return table;
}

std::string value_text(const TomlNode* node) {
  if (node == nullptr) return "absent";
  if (is_table(*node) || holds_tables(*node)) return "present";
  return json_of(*node).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void add_differences(const std::string& key, const TomlNode* before, const TomlNode* after,
                     Differences& all);

void add_members(const std::string& key, const TomlNode& before, const TomlNode& after,
                 Differences& all) {
  const std::string prefix = key.empty() ? "" : key + ".";
  for (const std::string& name : before.keys) {
    add_differences(prefix + name, before.find(name), after.find(name), all);
  }
  for (const std::string& name : after.keys) {
    if (before.find(name) == nullptr) {
      add_differences(prefix + name, nullptr, after.find(name), all);
    }
  }
}

void add_differences(const std::string& key, const TomlNode* before, const TomlNode* after,
                     Differences& all) {
  if (before != nullptr && after != nullptr) {
    if (is_table(*before) && is_table(*after)) return add_members(key, *before, *after, all);
    if (holds_tables(*before) && holds_tables(*after)) {
      return add_members(key, by_label(*before), by_label(*after), all);
    }
  }
  const bool one_lacks_it = (before == nullptr) != (after == nullptr);
  const std::string old = value_text(before), now = value_text(after);
  if (one_lacks_it || old != now) all.push_back({key, old, now});
}

/// SHA-256 by name: of several files where cases or variants have read one each.
std::map<std::string, std::set<std::string>> by_name(const std::vector<StoredFile>& files) {
  std::map<std::string, std::set<std::string>> hashes;
  for (const StoredFile& file : files) hashes[file.name].insert(file.sha256);
  return hashes;
}

bool has_all(const std::vector<StoredFile>& files, const std::set<std::string>& hashes) {
  return std::all_of(hashes.begin(), hashes.end(), [&](const std::string& hash) {
    return std::any_of(files.begin(), files.end(),
                       [&](const StoredFile& file) { return file.sha256 == hash; });
  });
}

}  // namespace

Differences differing_members(const TomlNode& before, const TomlNode& after) {
  Differences all;
  add_members("", before, after, all);
  return all;
}

Differences differing_keys(const TomlNode& before, const TomlNode& after) {
  TomlNode old = before, now = after;
  for (TomlNode* root : {&old, &now}) {
    root->erase("figure_view");
    root->erase("check");
  }
  return differing_members(old, now);
}

std::vector<InputDifference> differing_inputs(const std::vector<StoredFile>& before,
                                              const std::vector<StoredFile>& after) {
  auto old = by_name(before), now = by_name(after);
  std::set<std::string> names;
  for (const StoredFile& file : before) names.insert(file.name);
  for (const StoredFile& file : after) names.insert(file.name);
  std::vector<InputDifference> all;
  for (const std::string& name : names) {
    const std::set<std::string>&x = old[name], &y = now[name];
    const bool lies_elsewhere =
        (y.empty() && has_all(after, x)) || (x.empty() && has_all(before, y));
    if (x != y && !lies_elsewhere) all.push_back({name, x, y});
  }
  return all;
}

}  // namespace geoprior
