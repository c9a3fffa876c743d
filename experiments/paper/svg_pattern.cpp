#include "experiments/paper/svg_pattern.h"

#include <algorithm>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "experiments/paper/svg_outline.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/nesting.h"

namespace geoprior::paper {
namespace {

// The keys of the scene that errors name.
const std::string kFileKey = "scene.pattern.file: ";
const std::string kPathKey = "scene.pattern.path: ";

/// Element name without namespace prefix.
std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::vector<pugi::xml_node> paths_of(pugi::xml_document& document) {
  struct Walker : pugi::xml_tree_walker {
    std::vector<pugi::xml_node> found;
    bool for_each(pugi::xml_node& node) override {
      if (local_name(node) == "path") found.push_back(node);
      return true;
    }
  } walker;
  document.traverse(walker);
  return walker.found;
}

std::string ids_of(const std::vector<pugi::xml_node>& paths) {
  std::string list;
  for (const pugi::xml_node& path : paths) {
    const std::string id = path.attribute("id").value();
    list += (list.empty() ? "" : ", ") + (id.empty() ? "(a path without id)" : id);
  }
  return list;
}

pugi::xml_node choose_path(const std::vector<pugi::xml_node>& paths,
                           const std::optional<std::string>& id, const std::string& file) {
  if (paths.empty())
    throw Error("has no path element", kFileKey + file, "an SVG file with a <path>");
  if (!id) {
    if (paths.size() == 1) return paths[0];
    throw Error(std::to_string(paths.size()) + " paths, and 'path' names none", kPathKey + file,
                ids_of(paths));
  }
  const auto found = std::find_if(paths.begin(), paths.end(), [&](const pugi::xml_node& path) {
    return *id == path.attribute("id").value();
  });
  if (found == paths.end())
    throw Error("no path with id '" + *id + "'", kPathKey + file, ids_of(paths));
  return *found;
}

void require_no_transform(const pugi::xml_node& path, const std::string& where) {
  for (pugi::xml_node node = path; node; node = node.parent()) {
    if (!node.attribute("transform")) continue;
    throw Error("has a transform on <" + std::string(node.name()) + ">, which is not applied",
                where, "path data in the coordinates of the drawing");
  }
}

}  // namespace

Pattern read_svg_pattern(const std::filesystem::path& file, const SvgPatternOptions& options) {
  const std::string text = read_whole_file(file);
  require_shallow_xml(text, kFileKey + file.string());
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) {
    throw Error("no valid XML: " + std::string(parsed.description()),
                kFileKey + file.string() + ", byte " + std::to_string(parsed.offset),
                "an SVG file");
  }
  const pugi::xml_node path = choose_path(paths_of(document), options.path, file.string());
  const std::string id = path.attribute("id").value();
  const std::string where =
      kFileKey + file.string() + ": path" + (id.empty() ? "" : " '" + id + "'");
  require_no_transform(path, where);
  Pattern pattern;
  pattern.border =
      flatten_svg_path(path.attribute("d").value(), options.tolerance / options.unit_m, where);
  Eigen::Vector2d low = pattern.border[0], high = low;
  for (const Eigen::Vector2d& p : pattern.border) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d origin =
      options.centred ? Eigen::Vector2d((low + high) / 2) : Eigen::Vector2d::Zero();
  for (Eigen::Vector2d& p : pattern.border) {
    p = options.unit_m * Eigen::Vector2d(p.x() - origin.x(), origin.y() - p.y());
  }
  if (signed_area(pattern) < 0) std::reverse(pattern.border.begin(), pattern.border.end());
  return pattern;
}

}  // namespace geoprior::paper
