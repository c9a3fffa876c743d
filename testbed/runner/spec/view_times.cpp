#include "testbed/runner/spec/view_times.h"

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/quantity.h"
#include "testbed/runner/spec/overrides.h"
#include "testbed/runner/spec/resolve.h"
#include "testbed/runner/spec/sweeps.h"

namespace geoprior {
namespace {

bool is_number(const TomlNode& node) {
  return node.kind == TomlNode::Kind::integer || node.kind == TomlNode::Kind::real;
}

double number_of(const TomlNode& node) {
  return node.kind == TomlNode::Kind::integer ? static_cast<double>(node.integer) : node.real;
}

/// A frame that the figure asks for.
struct WantedFrame {
  TomlNode* node = nullptr;
  std::string key;
};

/// What is no number is left to the reader of the table, which says so.
std::vector<WantedFrame> wanted_frames(TomlNode& root) {
  std::vector<WantedFrame> wanted;
  TomlNode* view = root.find("figure_view");
  if (view == nullptr) return wanted;
  const auto add = [&](TomlNode& node, const std::string& key) {
    if (is_number(node)) wanted.push_back({&node, "figure_view." + key});
  };
  if (TomlNode* one = view->find("at_parameter")) add(*one, "at_parameter");
  for (const std::string key : {"at", "parameters"}) {
    TomlNode* list = view->find(key);
    if (list == nullptr) continue;
    for (TomlNode& item : list->items) add(item, key);
  }
  return wanted;
}

bool is_drawn(const SweptCase& swept, const TomlNode& root) {
  if (swept.claims_only) return false;
  const TomlNode* view = root.find("figure_view");
  const TomlNode* cases = view != nullptr ? view->find("cases") : nullptr;
  if (cases == nullptr || cases->items.empty()) return true;
  return std::any_of(cases->items.begin(), cases->items.end(),
                     [&](const TomlNode& name) { return name.text == swept.name; });
}

/// Of the run that the file describes. Where only [quick] or --set make the file complete it
/// describes none, and the run that is made decides: what is wrong with that is said elsewhere.
std::optional<LastParameter> described_end(TomlNode file, const Topic& topic) {
  apply_quick(file, false);
  try {
    return last_parameter_of(file, topic, false);
  } catch (const Error&) {
    return std::nullopt;
  }
}

bool lies_beyond(double parameter, double end) {
  return parameter > end && !same_parameter(parameter, end);
}

}  // namespace

std::optional<LastParameter> last_parameter_of(const TomlNode& root, const Topic& topic,
                                               bool quick) {
  std::optional<LastParameter> last;
  TomlNode plain = root;
  plain.erase("sweep");
  for (const SweptCase& swept : expand_sweeps(root, quick)) {
    if (!is_drawn(swept, root)) continue;
    std::string unused;
    const auto end = topic.last_parameter(*resolve_scene(root_of(swept, plain), topic, unused));
    if (!end) return std::nullopt;
    if (!last || end->value > last->value) last = end;
  }
  return last;
}

void settle_view_times(const TomlNode& file, TomlNode& root, const Topic& topic, bool quick) {
  const std::vector<WantedFrame> wanted = wanted_frames(root);
  if (wanted.empty() || !topic.last_parameter) return;
  const auto own = last_parameter_of(root, topic, quick);
  if (!own) return;
  const auto described = described_end(file, topic);
  const double end = std::max(own->value, described ? described->value : own->value);
  const auto with_unit = [&](double value) {
    return number_text(value) + (own->unit.empty() ? "" : " " + own->unit);
  };
  for (const WantedFrame& frame : wanted) {
    const double parameter = number_of(*frame.node);
    if (lies_beyond(parameter, end)) {
      throw Error(with_unit(parameter) + " lies beyond the end of the run",
                  frame.node->place + ": " + frame.key, "at most " + with_unit(end));
    }
    if (!lies_beyond(parameter, own->value)) continue;
    frame.node->kind = TomlNode::Kind::real;
    frame.node->real = own->value;
  }
}

}  // namespace geoprior
