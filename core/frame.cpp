#include "core/frame.h"

#include <algorithm>
#include <sstream>

#include "core/error.h"

namespace geoprior {
namespace {

std::string element_of(NamedArray::On on) {
  return on == NamedArray::On::points ? "point" : "cell";
}

std::string components_text(Eigen::Index components) {
  return std::to_string(components) + (components == 1 ? " component" : " components");
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

std::string arrays_of(const Part& part) {
  std::vector<std::string> names;
  for (const NamedArray& a : part.arrays) {
    names.push_back(element_of(a.on) + " array '" + a.name + "' of " +
                    components_text(a.values.cols()));
  }
  return listed(names);
}

template <class Named>
std::string keys_of(const std::map<std::string, Named>& named) {
  std::vector<std::string> names;
  for (const auto& entry : named) names.push_back("'" + entry.first + "'");
  return listed(names);
}

std::string place_of(const Frame& frame) {
  std::ostringstream text;
  text << "frame at " << frame.parameter;
  return text.str();
}

template <class Named>
const Named* find(const std::map<std::string, Named>& named, const std::string& name) {
  const auto found = named.find(name);
  return found == named.end() ? nullptr : &found->second;
}

}  // namespace

std::string kind_name(Part::Kind kind) {
  switch (kind) {
    case Part::Kind::triangles:
      return "triangles";
    case Part::Kind::lines:
      return "lines";
    case Part::Kind::points:
      return "points";
    case Part::Kind::grid:
      return "grid";
  }
  return "";
}

Eigen::Index Part::count(NamedArray::On on) const {
  const bool of_points = on == NamedArray::On::points;
  if (kind == Kind::grid) {
    Eigen::Index product = 1;
    for (const int n : grid_size) product *= of_points ? n : std::max(n - 1, 1);
    return product;
  }
  if (of_points || kind == Kind::points) return points.rows();
  return kind == Kind::triangles ? triangles.rows() : std::ssize(lines);
}

const NamedArray* Part::find_array(std::string_view name) const {
  const auto found = std::find_if(arrays.begin(), arrays.end(),
                                  [&](const NamedArray& array) { return array.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

const NamedArray* Part::find_array(std::string_view name, NamedArray::On on) const {
  const auto found = std::find_if(arrays.begin(), arrays.end(), [&](const NamedArray& array) {
    return array.name == name && array.on == on;
  });
  return found == arrays.end() ? nullptr : &*found;
}

const NamedArray& Part::require_array(std::string_view name, NamedArray::On on,
                                      std::optional<int> components,
                                      const std::string& where) const {
  const NamedArray* array = find_array(name, on);
  const std::string what = element_of(on) + " array '" + std::string(name) + "'";
  if (array == nullptr || (components && array->values.cols() != *components)) {
    throw Error("has no " + what + (components ? " of " + components_text(*components) : "") +
                    ", but: " + arrays_of(*this),
                where);
  }
  if (array->values.rows() != count(on)) {
    throw Error(what + " has " + std::to_string(array->values.rows()) + " rows", where,
                std::to_string(count(on)) + ", one a " + element_of(on));
  }
  return *array;
}

const Part* Frame::find_part(const std::string& name) const { return find(parts, name); }

const FrameTable* Frame::find_table(const std::string& name) const { return find(tables, name); }

const Part& Frame::require_part(const std::string& name) const {
  if (const Part* part = find_part(name)) return *part;
  throw Error("has no part '" + name + "', but: " + keys_of(parts), place_of(*this));
}

const Part& Frame::require_part(const std::string& name, Part::Kind kind) const {
  const Part& part = require_part(name);
  if (part.kind == kind) return part;
  throw Error("part '" + name + "' is of kind " + kind_name(part.kind), place_of(*this),
              kind_name(kind));
}

const FrameTable& Frame::require_table(const std::string& name) const {
  if (const FrameTable* table = find_table(name)) return *table;
  throw Error("has no table '" + name + "', but: " + keys_of(tables), place_of(*this));
}

const NamedArray& Frame::require_array(const std::string& part, std::string_view name,
                                       NamedArray::On on, std::optional<int> components) const {
  return require_part(part).require_array(name, on, components,
                                          place_of(*this) + ", part '" + part + "'");
}

}  // namespace geoprior
