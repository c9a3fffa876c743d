#include "testbed/runner/spec/overrides.h"

#include <algorithm>

#include "core/error.h"

namespace geoprior {
namespace {

const std::vector<std::string> kTopLevel{
    "title", "figure", "topic", "id",     "size",      "seed",  "threads",     "scene", "variant",
    "claim", "sweep",  "study", "timing", "tolerance", "quick", "figure_view", "check", "input"};
constexpr std::string_view kKeys =
    "scene.*, seed, threads, timing.*, figure_view.*, variant.<name>.options.*";

TomlNode* variant_named(TomlNode& root, const std::string& name) {
  TomlNode* variants = root.find("variant");
  if (variants == nullptr) return nullptr;
  for (TomlNode& variant : variants->items) {
    const TomlNode* has = variant.find("name");
    if (has != nullptr && has->text == name) return &variant;
  }
  return nullptr;
}

std::vector<std::string> variant_names(const TomlNode& root) {
  std::vector<std::string> names;
  for (const TomlNode& variant : tables_of(root, "variant")) {
    if (const TomlNode* name = variant.find("name")) names.push_back(name->text);
  }
  return names;
}

template <class LeftOut>
void leave_out_claims(TomlNode& root, LeftOut is_left_out) {
  TomlNode* claims = root.find("claim");
  if (claims == nullptr) return;
  std::erase_if(claims->items, is_left_out);
  if (claims->items.empty()) root.erase("claim");
}

/// `quick = false`. Values of another type are refused where claims are read.
bool is_too_long_for_quick_runs(const TomlNode& claim) {
  const TomlNode* key = claim.find("quick");
  return key != nullptr && key->kind == TomlNode::Kind::boolean && !key->boolean;
}

bool is_over_seeds(const TomlNode& claim) {
  const TomlNode* over = claim.find("over");
  return over != nullptr && over->text == "seed";
}

/// --set sweep=[]: the file's own values alone, one seed of which decides no claim over seeds.
void take_sweeps_out(TomlNode& root, const TomlNode& value) {
  if (value.kind != TomlNode::Kind::array || !value.items.empty())
    throw Error("sweeps can only be taken out", value.place, "sweep=[]");
  root.erase("sweep");
  leave_out_claims(root, is_over_seeds);
}

}  // namespace

std::vector<TomlNode> tables_of(const TomlNode& root, const std::string& key) {
  const TomlNode* node = root.find(key);
  return node == nullptr ? std::vector<TomlNode>{} : node->items;
}

void require_known_tables(const TomlNode& root) {
  for (std::size_t i = 0; i < root.keys.size(); ++i) {
    const std::string& key = root.keys[i];
    const TomlNode& node = root.items[i];
    if (std::find(kTopLevel.begin(), kTopLevel.end(), key) == kTopLevel.end()) {
      throw Error("unknown key", node.place + ": " + key, allowed_names(key, kTopLevel));
    }
    for (const std::string table :
         {"scene", "timing", "tolerance", "quick", "figure_view", "check"}) {
      if (key == table && node.kind != TomlNode::Kind::table) {
        throw Error("is " + node.kind_name(), node.place + ": " + key, "a table, [" + key + "]");
      }
    }
    for (const std::string list : {"variant", "claim", "sweep", "study"}) {
      if (key != list) continue;
      const bool tables = node.kind == TomlNode::Kind::array &&
                          std::all_of(node.items.begin(), node.items.end(), [](const auto& item) {
                            return item.kind == TomlNode::Kind::table;
                          });
      if (!tables) {
        throw Error("is " + node.kind_name(), node.place + ": " + key,
                    "an array of tables, [[" + key + "]]");
      }
    }
  }
}

void set_experiment_key(TomlNode& root, const std::string& key, const TomlNode& value) {
  const std::vector<std::string> parts = split_dotted_key(key, value.place);
  const std::string& first = parts.front();
  const bool whole = first == "seed" || first == "threads";
  const bool nested = first == "scene" || first == "timing" || first == "figure_view";
  if ((whole && parts.size() == 1) || (nested && parts.size() > 1)) {
    set_at(root, parts, value);
    return;
  }
  if (first != "variant" || parts.size() < 4 || parts[2] != "options") {
    throw Error("'" + key + "' cannot be set", value.place, std::string(kKeys));
  }
  TomlNode* variant = variant_named(root, parts[1]);
  if (variant == nullptr) {
    throw Error("there is no variant '" + parts[1] + "'", value.place + ": " + key,
                allowed_names(parts[1], variant_names(root)));
  }
  set_at(*variant, {parts.begin() + 2, parts.end()}, value);
}

void apply_quick(TomlNode& root, bool quick) {
  if (const TomlNode* table = root.find("quick"); table != nullptr && quick) {
    const TomlNode overrides = *table;
    for (std::size_t i = 0; i < overrides.keys.size(); ++i) {
      set_experiment_key(root, overrides.keys[i], overrides.items[i]);
    }
  }
  root.erase("quick");
  if (quick) leave_out_claims(root, is_too_long_for_quick_runs);
}

void apply_sets(TomlNode& root, const std::vector<std::string>& sets) {
  for (const std::string& set : sets) {
    const std::size_t equals = set.find('=');
    const std::string place = "--set " + set;
    if (equals == std::string::npos || equals == 0) {
      throw Error("has no key and value", place, "key=value, for example scene.frames=4");
    }
    const auto trimmed = [](std::string text) {
      text.erase(0, text.find_first_not_of(" \t"));
      text.erase(text.find_last_not_of(" \t") + 1);
      return text;
    };
    const std::string key = trimmed(set.substr(0, equals));
    const TomlNode value = parse_toml_value(trimmed(set.substr(equals + 1)), place);
    if (key == "sweep") {
      take_sweeps_out(root, value);
    } else {
      set_experiment_key(root, key, value);
    }
  }
}

}  // namespace geoprior
