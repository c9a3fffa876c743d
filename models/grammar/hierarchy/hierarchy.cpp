#include "models/grammar/hierarchy/hierarchy.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace geoprior::grammar {

int ElementType::parameter(const std::string& name_of_it) const {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].name == name_of_it) return static_cast<int>(i);
  std::string names;
  for (const ParameterType& p : parameters) names += (names.empty() ? "" : ", ") + p.name;
  throw Error("has no parameter '" + name_of_it + "'", "type '" + name + "'",
              names.empty() ? "none" : names);
}

Hierarchy::Hierarchy(std::vector<ElementType> types) : types_(std::move(types)) {}

int Hierarchy::add_type(ElementType type) {
  types_.push_back(std::move(type));
  return static_cast<int>(types_.size()) - 1;
}

int Hierarchy::add(int type, int parent, const Pose& pose, std::span<const double> parameters,
                   std::span<const Eigen::Vector3d> points) {
  if (type < 0 || type >= static_cast<int>(types_.size()))
    throw Error("there is no type " + std::to_string(type), "new element");
  const std::string where = "new element of type '" + types_[type].name + "'";
  if (parent < -1 || parent >= size() || (parent == -1) != (size() == 0))
    throw Error("there is no parent " + std::to_string(parent), where);
  if (parameters.size() != types_[type].parameters.size())
    throw Error("has " + std::to_string(parameters.size()) + " parameters", where,
                std::to_string(types_[type].parameters.size()));
  const int element = size();
  type_.push_back(type);
  parent_.push_back(parent);
  children_.emplace_back();
  if (parent >= 0) children_[parent].push_back(element);
  present_.push_back(1);
  ++present_count_;
  position_.push_back(pose.position);
  turn_.push_back(pose.turn);
  first_value_.push_back(values_.size());
  values_.insert(values_.end(), parameters.begin(), parameters.end());
  if (!points.empty()) points_[element].assign(points.begin(), points.end());
  return element;
}

void Hierarchy::reserve(std::size_t elements, std::size_t parameters) {
  type_.reserve(elements);
  parent_.reserve(elements);
  children_.reserve(elements);
  present_.reserve(elements);
  position_.reserve(elements);
  turn_.reserve(elements);
  first_value_.reserve(elements);
  values_.reserve(parameters);
}

int Hierarchy::find_type(const std::string& name) const {
  for (std::size_t i = 0; i < types_.size(); ++i)
    if (types_[i].name == name) return static_cast<int>(i);
  return -1;
}

std::span<const Eigen::Vector3d> Hierarchy::points(int element) const {
  const auto found = points_.find(element);
  if (found == points_.end()) return {};
  return found->second;
}

std::span<Eigen::Vector3d> Hierarchy::points(int element) {
  const auto found = points_.find(element);
  if (found == points_.end()) return {};
  return found->second;
}

void Hierarchy::set_present(int element, bool present) {
  if ((present_[element] != 0) == present) return;
  present_[element] = present ? 1 : 0;
  present_count_ += present ? 1 : -1;
}

void Hierarchy::truncate(int size_then) {
  for (int element = size() - 1; element >= size_then; --element) {
    set_present(element, false);
    if (const int parent = parent_[element]; parent >= 0) children_[parent].pop_back();
    points_.erase(element);
    names_.erase(element);
    tags_.erase(element);
  }
  if (size_then >= size()) return;
  values_.resize(first_value_[size_then]);
  type_.resize(size_then);
  parent_.resize(size_then);
  children_.resize(size_then);
  present_.resize(size_then);
  position_.resize(size_then);
  turn_.resize(size_then);
  first_value_.resize(size_then);
}

std::string Hierarchy::label(int element) const {
  if (const auto found = names_.find(element); found != names_.end()) return found->second;
  int number = 0;
  for (int other = 0; other <= element; ++other) number += type_[other] == type_[element];
  return type(element).name + "-" + std::to_string(number);
}

int Hierarchy::find(const std::string& label, const std::string& where) const {
  for (const auto& [element, name] : names_)
    if (name == label) return element;
  const std::size_t dash = label.rfind('-');
  if (dash != std::string::npos) {
    int number = 0;
    const char* end = label.data() + label.size();
    const auto [stopped, error] = std::from_chars(label.data() + dash + 1, end, number);
    const int type = find_type(label.substr(0, dash));
    if (error == std::errc() && stopped == end && type >= 0)
      for (int element = 0; element < size(); ++element)
        if (type_[element] == type && --number == 0) return element;
  }
  std::string kinds;
  for (std::size_t t = 0; t < types_.size(); ++t) {
    const auto count = std::count(type_.begin(), type_.end(), static_cast<int>(t));
    if (count == 0) continue;
    kinds += (kinds.empty() ? "" : ", ") + types_[t].name + "-1";
    if (count > 1) kinds += " to " + types_[t].name + "-" + std::to_string(count);
  }
  throw Error("there is no element '" + label + "'", where, kinds);
}

void Hierarchy::keys(int element, std::vector<Eigen::Vector3d>& out) const {
  if (const auto own = points(element); !own.empty()) {
    out.insert(out.end(), own.begin(), own.end());
    return;
  }
  const ElementType& t = type(element);
  if (!t.keys) return;
  const std::size_t first = out.size();
  t.keys(parameters(element), out);
  for (std::size_t i = first; i < out.size(); ++i)
    out[i] = position_[element] + turn_[element] * out[i];
}

bool Hierarchy::is_below(int element, int ancestor) const {
  while (element >= 0 && element != ancestor) element = parent_[element];
  return element == ancestor;
}

void Hierarchy::require_valid() const {
  for (int element = 0; element < size(); ++element) {
    const auto bad = [&](const std::string& problem, const std::string& allowed = {}) {
      throw Error(problem, "element '" + label(element) + "'", allowed);
    };
    if (parent_[element] >= element) bad("comes before its parent");
    if (!position_[element].allFinite() || !turn_[element].coeffs().allFinite())
      bad("is at a place that is not finite");
    for (std::size_t p = 0; p < value_count(element); ++p) {
      const ParameterType& kind = type(element).parameters[p];
      const double value = parameter(element, static_cast<int>(p));
      if (!(value >= kind.low && value <= kind.high))
        bad("parameter '" + kind.name + "' is " + std::to_string(value),
            std::to_string(kind.low) + " to " + std::to_string(kind.high));
    }
    for (const Eigen::Vector3d& x : points(element))
      if (!x.allFinite()) bad("has a point that is not finite");
  }
}

}  // namespace geoprior::grammar
