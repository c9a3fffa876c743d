#include "experiments/sketch/drawing/view_layers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

constexpr std::string_view kViewPrefix = "view:";
constexpr const char* kViewLayers = "layers view:front, view:side, view:top, view:photo";
constexpr const char* kViewSets =
    "two or three of view:front, view:side, view:top, or view:photo alone";
constexpr std::array<ViewKind, 4> kViewKinds{ViewKind::front, ViewKind::side, ViewKind::top,
                                             ViewKind::photo};

/// What a layer's name is compared by: small letters without blanks, so that "View: Side" is
/// view:side; Illustrator writes the ':' of an id as "_x3A_".
std::string view_layer_name(const SvgGroup& group) {
  std::string name;
  for (const char c : group.name()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isspace(byte) == 0) name += static_cast<char>(std::tolower(byte));
  }
  constexpr std::string_view kColon = "_x3a_";
  const std::size_t at = name.find(kColon);
  return at == std::string::npos ? name : name.replace(at, kColon.size(), 1, ':');
}

std::string quoted_layer(const SvgGroup& group) { return "'" + group.name().substr(0, 50) + "'"; }

/// The view that a name without blanks means; none: it is no view's.
std::optional<ViewKind> view_kind(const SvgGroup& group, const std::string& place) {
  const std::string name = view_layer_name(group);
  if (!name.starts_with(kViewPrefix)) return std::nullopt;
  for (const ViewKind kind : kViewKinds) {
    if (name.substr(kViewPrefix.size()) == view_name(kind)) return kind;
  }
  throw Error("unknown view '" + group.name().substr(0, 100) + "'", place, kViewLayers);
}

/// ": its layers are a, b".
std::string layers_text(const SvgDocument& document) {
  std::string list;
  int count = 0;
  for (const SvgGroup& group : document.groups) {
    constexpr int kMostNamed = 10;
    if (group.layer && ++count <= kMostNamed)
      list += (list.empty() ? "" : ", ") + group.name().substr(0, 50);
  }
  return list.empty() ? "" : ": its layers are " + list;
}

/// Layers that are not read, for an error that may be about them; empty when there are none.
std::string unread_text(const std::vector<std::string>& hidden,
                        const std::vector<std::string>& other) {
  const auto list = [](const std::vector<std::string>& names, const char* what) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return names.empty() ? "" : (names.size() == 1 ? "; layer " : "; layers ") + text + what;
  };
  return list(hidden, " hidden, and not read") + list(other, " of no view, and not read");
}

void require_view_set(const std::vector<ViewKind>& kinds, const std::string& name,
                      const std::string& unread) {
  const bool photo = std::find(kinds.begin(), kinds.end(), ViewKind::photo) != kinds.end();
  if (photo && kinds.size() > 1) throw Error("has view:photo and other views", name, kViewSets);
  if (!photo && kinds.size() < 2) {
    throw Error("a second view is missing: there is only view:" +
                    std::string(view_name(kinds.front())) + unread,
                name, kViewSets);
  }
}

}  // namespace

ViewLayers find_view_layers(const SvgDocument& document, std::vector<std::string>& warnings) {
  ViewLayers layers;
  std::map<ViewKind, std::size_t> line_of;
  std::vector<std::string> hidden, other;
  bool any_hidden = false;
  for (int g = 0; g < std::ssize(document.groups); ++g) {
    const SvgGroup& group = document.groups[g];
    const std::string place = document.place("layer", group.tags);
    const std::optional<ViewKind> kind = view_kind(group, place);
    if (group.hidden) {
      if (!kind && !group.layer) continue;
      any_hidden = any_hidden || kind;
      hidden.push_back(quoted_layer(group));
      warnings.push_back(place + ": " + group.name() + " is hidden, and not read");
      continue;
    }
    if (!kind) {
      if (group.layer && !view_of_group(document, layers, g)) other.push_back(quoted_layer(group));
      continue;
    }
    const auto [known, is_new] = line_of.emplace(*kind, group.tags.line);
    if (!is_new) {
      throw Error(
          group.name() + " is drawn twice, here and on line " + std::to_string(known->second),
          place, "one layer for each view");
    }
    layers.kind_of_group.emplace(g, *kind);
  }
  for (const auto& [kind, line] : line_of) layers.kinds.push_back(kind);
  if (layers.kinds.empty()) {
    throw Error(any_hidden ? "every view is hidden" : "has no view" + layers_text(document),
                document.name, kViewLayers);
  }
  require_view_set(layers.kinds, document.name, unread_text(hidden, other));
  layers.unread = std::move(other);
  return layers;
}

std::optional<ViewKind> view_of_group(const SvgDocument& document, const ViewLayers& layers,
                                      int group) {
  for (; group >= 0; group = document.groups[group].parent) {
    const auto found = layers.kind_of_group.find(group);
    if (found != layers.kind_of_group.end()) return found->second;
  }
  return std::nullopt;
}

}  // namespace geoprior::sketch
