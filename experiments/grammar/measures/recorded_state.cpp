#include "experiments/grammar/measures/recorded_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

constexpr auto kOnPoints = NamedArray::On::points;

int whole_number(const NamedArray& array, Eigen::Index row) {
  return static_cast<int>(std::lround(array.values(row, 0)));
}

bool same_doubles(const double* a, const double* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof(double)) == 0;
}

}  // namespace

RecordedState::RecordedState(const Frame& frame, const std::vector<ElementType>& types)
    : types_(&types) {
  read_elements(frame);
  read_keys(frame);
}

RecordedState::RecordedState(const Hierarchy& hierarchy, std::span<const int> elements)
    : types_(&hierarchy.types()) {
  for (const int e : elements) add(hierarchy, e);
  std::sort(elements_.begin(), elements_.end(),
            [](const RecordedElement& a, const RecordedElement& b) { return a.number < b.number; });
}

RecordedState::RecordedState(const Hierarchy& hierarchy) : types_(&hierarchy.types()) {
  for (int e = 0; e < hierarchy.size(); ++e) add(hierarchy, e);
}

void RecordedState::add(const Hierarchy& hierarchy, int element) {
  if (element >= hierarchy.size() || !hierarchy.present(element)) return;
  RecordedElement& out = elements_.emplace_back();
  out.number = element;
  out.type = hierarchy.type_number(element);
  out.parent = hierarchy.parent(element);
  out.tagged = hierarchy.tag(element) != nullptr;
  out.pose = hierarchy.pose(element);
  const auto values = hierarchy.parameters(element);
  out.parameters.assign(values.begin(), values.end());
  hierarchy.keys(element, out.keys);
}

void RecordedState::read_elements(const Frame& frame) {
  const Part& part = frame.require_part("elements", Part::Kind::points);
  const auto array = [&](const char* name, std::optional<int> components) -> const NamedArray& {
    return part.require_array(name, kOnPoints, components, "elements");
  };
  const NamedArray &number = array("element", 1), &kind = array("type", 1),
                   &parent = array("parent", 1), &tagged = array("tagged", 1),
                   &turn = array("turn", 4), &values = array("parameters", {});
  for (Eigen::Index row = 0; row < part.points.rows(); ++row) {
    RecordedElement& e = elements_.emplace_back();
    e.number = whole_number(number, row);
    e.type = whole_number(kind, row);
    e.parent = whole_number(parent, row);
    e.tagged = tagged.values(row, 0) != 0;
    e.pose.position = part.points.row(row);
    e.pose.turn.coeffs() = turn.values.row(row).transpose();
    const std::string where = "element " + std::to_string(e.number);
    if (e.type < 0 || e.type >= static_cast<int>(types_->size()))
      throw Error("is of type " + std::to_string(e.type), where, "types of the scene");
    const auto count = static_cast<int>(type(e).parameters.size());
    if (count > values.values.cols())
      throw Error("has " + std::to_string(values.values.cols()) + " parameters", where,
                  std::to_string(count) + " of its type");
    for (int p = 0; p < count; ++p) e.parameters.push_back(values.values(row, p));
  }
  std::sort(elements_.begin(), elements_.end(),
            [](const RecordedElement& a, const RecordedElement& b) { return a.number < b.number; });
  for (std::size_t i = 1; i < elements_.size(); ++i)
    if (elements_[i].number == elements_[i - 1].number)
      throw Error("is there twice", "element " + std::to_string(elements_[i].number));
}

void RecordedState::read_keys(const Frame& frame) {
  const Part& part = frame.require_part("keys", Part::Kind::points);
  const NamedArray& element = part.require_array("element", kOnPoints, 1, "keys");
  const NamedArray& key = part.require_array("key", kOnPoints, 1, "keys");
  std::vector<std::array<int, 3>> rows;  // element, key, row
  for (Eigen::Index row = 0; row < part.points.rows(); ++row)
    rows.push_back({whole_number(element, row), whole_number(key, row), static_cast<int>(row)});
  std::sort(rows.begin(), rows.end());
  auto owner = elements_.begin();
  for (const auto& [number, k, row] : rows) {
    while (owner != elements_.end() && owner->number < number) ++owner;
    if (owner == elements_.end() || owner->number != number)
      throw Error("a key point is of element " + std::to_string(number), "keys",
                  "the frame's elements");
    if (k != static_cast<int>(owner->keys.size()))
      throw Error("key point " + std::to_string(k) + " comes after " +
                      std::to_string(owner->keys.size()) + " others",
                  "element " + std::to_string(number), "each once, from 0 on");
    owner->keys.emplace_back(part.points.row(row).transpose());
  }
}

const RecordedElement* RecordedState::find(int number) const {
  const auto found =
      std::lower_bound(elements_.begin(), elements_.end(), number,
                       [](const RecordedElement& e, int wanted) { return e.number < wanted; });
  return found == elements_.end() || found->number != number ? nullptr : &*found;
}

const RecordedElement* RecordedState::find_same(const RecordedElement& element) const {
  const RecordedElement* found = find(element.number);
  if (found == nullptr || found->type != element.type) return nullptr;
  return found->keys.size() == element.keys.size() ? found : nullptr;
}

std::vector<const RecordedElement*> RecordedState::of_type(const std::string& name) const {
  std::vector<const RecordedElement*> out;
  for (const RecordedElement& e : elements_)
    if (type_name(e) == name) out.push_back(&e);
  return out;
}

std::optional<double> RecordedState::parameter_if_any(const RecordedElement& element,
                                                      const std::string& name) const {
  const auto& parameters = type(element).parameters;
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const ParameterType& p) { return p.name == name; });
  if (found == parameters.end()) return std::nullopt;
  return element.parameters[static_cast<std::size_t>(found - parameters.begin())];
}

std::vector<int> RecordedState::numbers() const {
  std::vector<int> out;
  for (const RecordedElement& e : elements_) out.push_back(e.number);
  return out;
}

bool looks_the_same(const RecordedElement& a, const RecordedElement& b) {
  if (a.parameters.size() != b.parameters.size() || a.keys.size() != b.keys.size()) return false;
  if (!same_doubles(a.parameters.data(), b.parameters.data(), a.parameters.size())) return false;
  for (std::size_t k = 0; k < a.keys.size(); ++k)
    if (!same_doubles(a.keys[k].data(), b.keys[k].data(), 3)) return false;
  return true;
}

bool same_bytes(const RecordedElement& a, const RecordedElement& b) {
  return looks_the_same(a, b) && same_doubles(a.pose.position.data(), b.pose.position.data(), 3) &&
         same_doubles(a.pose.turn.coeffs().data(), b.pose.turn.coeffs().data(), 4);
}

}  // namespace geoprior::grammar
