#include "testbed/runner/spec/resolve.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/runner/names.h"
#include "testbed/runner/options/json.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/overrides.h"
#include "testbed/runner/spec/sweeps.h"
#include "testbed/runner/spec/tables.h"

namespace geoprior {
namespace {

/// Fills a fresh set of options from a table; absent table: defaults, required keys are asked for.
std::shared_ptr<const OptionSet> read_set(std::unique_ptr<OptionSet> set, const TomlNode* table,
                                          const std::string& place, const std::string& path,
                                          std::string& json) {
  TomlNode empty;
  empty.place = place;
  OptionTomlReader reader(table != nullptr ? *table : empty, path);
  set->visit(reader);
  reader.finish();
  OptionJsonWriter writer;
  set->visit(writer);
  json = writer.json().dump();
  return set;
}

/// Notes where a node and all below it are written.
void add_places(const TomlNode& node, const std::string& path,
                std::map<std::string, std::string>& places) {
  places[path] = node.place;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const bool is_table = node.kind == TomlNode::Kind::table;
    add_places(node.items[i], path + "." + (is_table ? node.keys[i] : std::to_string(i)), places);
  }
}

VariantTable read_variant_table(const TomlNode& node) {
  TomlNode plain = node;
  plain.erase("options");
  VariantTable table;
  read_options(plain, "variant", table);
  require_plain_name(table.name, "a variant", place_of(node, "name"));
  return table;
}

const MethodEntry& method_named(const Topic& topic, const std::string& name, const TomlNode& node) {
  std::vector<std::string> names;
  for (const MethodEntry& method : topic.methods) {
    if (method.name == name) return method;
    names.push_back(method.name);
  }
  throw Error("unknown method '" + name + "'", place_of(node, "method"),
              allowed_names(name, names));
}

std::string role_of(const VariantTable& table, const MethodEntry& method, const TomlNode& node) {
  if (!table.role) return method.is_baseline ? "baseline" : "method";
  const std::vector<std::string> roles{"method", "baseline", "ablation", "null"};
  if (std::find(roles.begin(), roles.end(), *table.role) == roles.end()) {
    throw Error("unknown role '" + *table.role + "'", place_of(node, "role"),
                allowed_names(*table.role, roles));
  }
  return *table.role;
}

VariantSpec resolve_variant(const TomlNode& node, const Topic& topic) {
  const VariantTable table = read_variant_table(node);
  const MethodEntry& method = method_named(topic, table.method, node);
  VariantSpec variant;
  variant.name = table.name;
  variant.method = table.method;
  variant.role = role_of(table, method, node);
  variant.reference = table.reference;
  variant.options = read_set(method.default_options(), node.find("options"), node.place,
                             "variant." + table.name + ".options", variant.options_json);
  if (const TomlNode* options = node.find("options")) {
    add_places(*options, "options", variant.option_places);
  }
  return variant;
}

}  // namespace

HeaderTable read_header(const TomlNode& root) {
  TomlNode plain = root;
  for (const char* table : {"scene", "variant", "claim", "sweep", "study", "timing", "tolerance",
                            "figure_view", "check"}) {
    plain.erase(table);
  }
  HeaderTable header;
  read_options(plain, "", header);
  return header;
}

std::vector<std::string> select_variants(const TomlNode& root,
                                         const std::vector<std::string>& requested, bool quick) {
  std::vector<std::string> names, quick_names;
  std::map<std::string, std::string> reference;
  for (const TomlNode& node : tables_of(root, "variant")) {
    const VariantTable table = read_variant_table(node);
    if (std::find(names.begin(), names.end(), table.name) != names.end()) {
      throw Error("two variants are called '" + table.name + "'", place_of(node, "name"),
                  "names of their own");
    }
    names.push_back(table.name);
    if (table.quick) quick_names.push_back(table.name);
    if (table.reference) reference[table.name] = *table.reference;
  }
  if (names.empty()) {
    throw Error("has no variants", root.place, "at least one [[variant]]");
  }
  if (quick_names.empty()) {
    throw Error("has no variant of quick runs", root.place,
                "at least one [[variant]] without `quick = false`");
  }
  const auto contains = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  for (const TomlNode& node : tables_of(root, "variant")) {
    const TomlNode* to = node.find("reference");
    if (to == nullptr) continue;
    if (!contains(names, to->text)) {
      throw Error("there is no variant '" + to->text + "'", to->place + ": reference",
                  allowed_names(to->text, names));
    }
    if (contains(quick_names, node.find("name")->text) && !contains(quick_names, to->text)) {
      throw Error("variant '" + to->text + "' is left out of quick runs", to->place + ": reference",
                  "a reference without `quick = false`");
    }
  }
  std::vector<std::string> selected;
  const auto add = [&](std::string name) {
    while (!contains(selected, name)) {
      selected.push_back(name);
      if (!reference.contains(name)) break;
      name = reference[name];
    }
  };
  if (requested.empty() && quick && quick_names.size() < names.size()) {
    for (const std::string& name : quick_names) add(name);
  }
  for (const std::string& name : requested) {
    if (!contains(names, name)) {
      throw Error("there is no variant '" + name + "'", "--variant", allowed_names(name, names));
    }
    add(name);
  }
  return selected;
}

std::shared_ptr<const OptionSet> resolve_scene(const TomlNode& root, const Topic& topic,
                                               std::string& json) {
  return read_set(topic.default_scene(), root.find("scene"), root.place, "scene", json);
}

CaseSpec resolve_case(const SweptCase& swept, const TomlNode& plain, const Topic& topic,
                      const std::vector<std::string>& selected) {
  const TomlNode root = root_of(swept, plain);
  CaseSpec result;
  result.name = swept.name;
  result.swept = swept.swept;
  result.claims_only = swept.claims_only;
  const HeaderTable values = read_header(root);
  result.seed = values.seed;
  result.threads = values.threads;
  result.scene = resolve_scene(root, topic, result.scene_json);
  if (const TomlNode* scene = root.find("scene")) {
    add_places(*scene, "scene", result.scene_places);
  }
  const auto runs = [](const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<std::string> names;
  for (const TomlNode& node : tables_of(root, "variant")) {
    VariantSpec variant = resolve_variant(node, topic);
    names.push_back(variant.name);
    if (runs(selected, variant.name) && runs(swept.variants, variant.name)) {
      result.variants.push_back(std::move(variant));
    }
  }
  for (const std::string& name : swept.variants) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error("there is no variant '" + name + "'", root.place + ": sweep.variants",
                  allowed_names(name, names));
    }
  }
  return result;
}

}  // namespace geoprior
