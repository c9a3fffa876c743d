#include "testbed/runner/spec/sweeps.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/runner/names.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/json.h"
#include "testbed/runner/spec/overrides.h"

namespace geoprior {
namespace {

struct Sweep {
  SweepTable table;
  std::vector<TomlNode> values;
  std::vector<std::string> names;  ///< one a value
  std::string place;               ///< of the values
};

std::string value_text(const TomlNode& value, std::size_t index) {
  switch (value.kind) {
    case TomlNode::Kind::text:
      return value.text;
    case TomlNode::Kind::real:
      return number_text(value.real);
    case TomlNode::Kind::integer:
      return std::to_string(value.integer);
    case TomlNode::Kind::boolean:
      return value.boolean ? "true" : "false";
    case TomlNode::Kind::array: {
      std::string joined;
      for (std::size_t i = 0; i < value.items.size(); ++i) {
        joined += (i == 0 ? "" : "-") + value_text(value.items[i], i);
      }
      return joined;
    }
    case TomlNode::Kind::table:
      return std::to_string(index);
  }
  return std::to_string(index);
}

std::vector<TomlNode> values_of(const TomlNode& table, const char* key, bool required) {
  const TomlNode* node = table.find(key);
  if (node == nullptr && !required) return {};
  const bool no_array = node == nullptr || node->kind != TomlNode::Kind::array;
  if (no_array || (required && node->items.empty())) {
    throw Error(node == nullptr ? "is missing" : "has no values",
                (node == nullptr ? table : *node).place + ": sweep." + key, "an array of values");
  }
  return node->items;
}

/// The `names` of the sweep, in which a space is a hyphen.
void read_names(const TomlNode& node, Sweep& sweep) {
  for (std::size_t i = 0; i < sweep.table.names.size(); ++i) {
    std::string& name = sweep.table.names[i];
    std::replace(name.begin(), name.end(), ' ', '-');
    require_name(name, "a case", node.find("names")->items[i].place + ": sweep.names");
  }
}

/// Names of the values; a quick value keeps the name of the full one that it equals, or that it
/// stands in for where there are as many.
std::vector<std::string> value_names(const Sweep& sweep, const std::vector<TomlNode>& full,
                                     const std::string& label) {
  std::map<nlohmann::ordered_json, std::string> given;
  for (std::size_t j = 0; j < sweep.table.names.size(); ++j) {
    given[json_of(full[j])] = sweep.table.names[j];
  }
  const bool one_for_one = sweep.table.names.size() == sweep.values.size();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sweep.values.size(); ++i) {
    const auto found = given.find(json_of(sweep.values[i]));
    if (found != given.end()) {
      names.push_back(found->second);
    } else if (one_for_one) {
      names.push_back(sweep.table.names[i]);
    } else {
      names.push_back(with_name_characters(label + "=" + value_text(sweep.values[i], i)));
    }
  }
  return names;
}

void require_sweepable(const SweepTable& table, const TomlNode& node) {
  const std::string& key = table.key;
  const bool allowed = key == "seed" || key == "threads" || key == "scene" ||
                       key.starts_with("scene.") ||
                       (key.starts_with("variant.") && key.find(".options.") != std::string::npos);
  if (allowed) return;
  const TomlNode* place = node.find("key");
  throw Error("'" + key + "' cannot be swept", (place != nullptr ? *place : node).place + ": key",
              "scene, scene.*, seed, threads, variant.<name>.options.*");
}

Sweep read_sweep(const TomlNode& node, bool quick) {
  Sweep sweep;
  sweep.table = read_sweep_table(node);
  require_sweepable(sweep.table, node);
  const std::vector<TomlNode> full = values_of(node, "values", true);
  const std::vector<TomlNode> reduced = values_of(node, "quick_values", false);
  if (!sweep.table.names.empty() && sweep.table.names.size() != full.size()) {
    throw Error(std::to_string(sweep.table.names.size()) + " names", node.place + ": sweep.names",
                std::to_string(full.size()) + ", one a value");
  }
  read_names(node, sweep);
  const bool is_reduced = quick && node.find("quick_values") != nullptr;
  sweep.values = is_reduced ? reduced : full;
  const char* key_of_values = is_reduced ? "quick_values" : "values";
  sweep.place = node.find(key_of_values)->place + ": sweep." + key_of_values;
  const std::string& key = sweep.table.key;
  sweep.names = value_names(sweep, full, key.substr(key.rfind('.') + 1));
  return sweep;
}

void apply(SweptCase& result, const Sweep& sweep, std::size_t i) {
  const TomlNode& value = sweep.values[i];
  if (sweep.table.key == "scene") {
    // A table of several scene keys: those it names change, the others stay.
    if (value.kind != TomlNode::Kind::table) {
      throw Error("is " + value.kind_name(), value.place + ": sweep.values",
                  "tables of scene keys");
    }
    for (std::size_t k = 0; k < value.keys.size(); ++k) {
      result.changes.emplace_back("scene." + value.keys[k], value.items[k]);
    }
  } else {
    result.changes.emplace_back(sweep.table.key, value);
  }
  result.name = result.name == "default" ? sweep.names[i] : result.name + "," + sweep.names[i];
  require_name(result.name, "a case (give the sweeps `names`)", value.place + ": sweep.values");
  result.swept[sweep.table.key] = json_of(sweep.values[i]).dump();
  for (const std::string& name : sweep.table.variants) result.variants.push_back(name);
  result.claims_only = result.claims_only || sweep.table.claims_only;
}

double values_in(const TomlNode& node) {
  double count = 1;
  for (const TomlNode& item : node.items) count += values_in(item);
  return count;
}

/// Cases of the first `count` sweeps, the base case among them.
double case_count(const std::vector<Sweep>& sweeps, std::size_t count) {
  double alone = 1, grid = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto values = static_cast<double>(sweeps[i].values.size());
    if (sweeps[i].table.grid) {
      grid = std::max(grid, 1.0) * values;
    } else {
      alone += values;
    }
  }
  return alone + grid;
}

/// Counts the cases before any is made; an error names the sweep with which they are too many.
/// @param values_of_case  that the file has beside its sweeps: every case resolves them
void require_few_cases(const std::vector<Sweep>& sweeps, double values_of_case) {
  constexpr double kBytesPerValue = 500;  // as an option, as text, with its place
  const double most = std::min(kMostCases, memory_limit() / (values_of_case * kBytesPerValue));
  std::size_t too_many = 1;
  while (too_many <= sweeps.size() && case_count(sweeps, too_many) <= most) ++too_many;
  if (too_many > sweeps.size()) return;
  // A later sweep without values makes none of the grid; it would be made up to there.
  const double cases = std::max(case_count(sweeps, too_many), case_count(sweeps, sweeps.size()));
  const std::string& place = sweeps[too_many - 1].place;
  require_count(cases, "cases", kMostCases, place);
  require_memory(cases * values_of_case * kBytesPerValue, cases, "cases", place);
}

std::vector<SweptCase> grid_product(const std::vector<Sweep>& sweeps) {
  std::vector<SweptCase> cases(1);
  bool any = false;
  for (const Sweep& sweep : sweeps) {
    if (!sweep.table.grid) continue;
    any = true;
    std::vector<SweptCase> product;
    for (const SweptCase& outer : cases) {
      for (std::size_t i = 0; i < sweep.values.size(); ++i) {
        product.push_back(outer);
        apply(product.back(), sweep, i);
      }
    }
    cases = std::move(product);
  }
  if (!any) cases.clear();
  return cases;
}

/// Two sweeps of options of one name (of two variants): the whole key tells them apart.
void make_names_unique(std::vector<Sweep>& sweeps) {
  std::map<std::string, std::set<std::string>> keys_of_name;
  for (const Sweep& sweep : sweeps) {
    for (const std::string& name : sweep.names) keys_of_name[name].insert(sweep.table.key);
  }
  for (Sweep& sweep : sweeps) {
    if (!sweep.table.names.empty()) continue;
    const bool clash = std::any_of(sweep.names.begin(), sweep.names.end(),
                                   [&](const auto& name) { return keys_of_name[name].size() > 1; });
    if (!clash) continue;
    for (std::size_t i = 0; i < sweep.names.size(); ++i) {
      sweep.names[i] = with_name_characters(sweep.table.key + "=" + value_text(sweep.values[i], i));
    }
  }
}

}  // namespace

SweepTable read_sweep_table(const TomlNode& node) {
  TomlNode plain = node;
  plain.erase("values");
  plain.erase("quick_values");
  SweepTable table;
  read_options(plain, "sweep", table);
  return table;
}

std::vector<SweptCase> expand_sweeps(const TomlNode& root, bool quick) {
  std::vector<Sweep> sweeps;
  for (const TomlNode& node : tables_of(root, "sweep")) sweeps.push_back(read_sweep(node, quick));
  const TomlNode* tables = root.find("sweep");
  require_few_cases(sweeps, values_in(root) - (tables != nullptr ? values_in(*tables) : 0));
  make_names_unique(sweeps);

  std::vector<SweptCase> cases;
  const bool with_base = std::all_of(sweeps.begin(), sweeps.end(),
                                     [](const Sweep& sweep) { return sweep.table.base; });
  if (with_base) cases.emplace_back();
  for (const Sweep& sweep : sweeps) {
    for (std::size_t i = 0; !sweep.table.grid && i < sweep.values.size(); ++i) {
      cases.emplace_back();
      apply(cases.back(), sweep, i);
    }
  }
  for (SweptCase& made : grid_product(sweeps)) cases.push_back(std::move(made));

  std::set<std::string> names;
  for (const SweptCase& made : cases) {
    if (!names.insert(made.name).second) {
      throw Error("two cases are called '" + made.name + "'", root.place + ": sweep",
                  "different values, or `names` that differ");
    }
  }
  return cases;
}

TomlNode root_of(const SweptCase& swept, const TomlNode& plain) {
  TomlNode root = plain;
  for (const auto& [key, value] : swept.changes) set_experiment_key(root, key, value);
  return root;
}

}  // namespace geoprior
