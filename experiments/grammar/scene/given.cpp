#include <string>
#include <utility>
#include <vector>

#include "experiments/grammar/measures/asked.h"
#include "experiments/grammar/scene/scene.h"
#include "models/grammar/record.h"
#include "testbed/given_tables.h"

namespace geoprior::grammar {
namespace {

/// Key points of all steps together; with more, where they are asked to be is not given.
constexpr Eigen::Index kMostGiven = 10'000'000;

/// The object at rest, its types with their names.
Frame rest_frame(const GrammarScene& scene) {
  const bool surface = scene.record == GrammarSceneOptions::Record::surface;
  Frame frame = frame_of(0, scene.rest, geometry_of(scene.rest, surface));
  std::vector<std::string> names;
  for (const ElementType& type : scene.rest.types()) names.push_back(type.name);
  for (auto& [part_name, part] : frame.parts)
    for (NamedArray& array : part.arrays)
      if (array.name == "type") array.names = names;
  return frame;
}

void give_types(const Hierarchy& rest, Frame& frame) {
  TableBuilder ranges({"type", "parameter", "low", "high"});
  for (int t = 0; t < std::ssize(rest.types()); ++t) {
    const std::vector<ParameterType>& parameters = rest.types()[t].parameters;
    std::vector<std::string> columns{"element"};
    for (int p = 0; p < std::ssize(parameters); ++p) {
      columns.push_back(parameters[p].name + " [" + parameters[p].unit + "]");
      ranges.add({1. * t, 1. * p, parameters[p].low, parameters[p].high});
    }
    TableBuilder elements(columns);
    for (int e = 0; e < rest.size(); ++e) {
      if (!rest.present(e) || rest.type_number(e) != t) continue;
      std::vector<double> row{1. * e};
      const auto values = rest.parameters(e);
      row.insert(row.end(), values.begin(), values.end());
      elements.add(row);
    }
    frame.tables[numbered("type", t)] = elements.finished();
  }
  frame.tables["ranges"] = ranges.finished();
}

/// The key points `keys` of the rest, where they are asked to be.
Part asked_part(const AskedPlaces& asked, const Hierarchy& rest, const Part& keys) {
  Part part;
  part.kind = Part::Kind::points;
  part.points.resize(keys.points.rows(), 3);
  Eigen::Index row = 0;
  for (int e = 0; e < rest.size(); ++e) {
    if (!rest.present(e)) continue;
    for (const Eigen::Vector3d& x : asked.keys(e)) {
      if (row < part.points.rows()) part.points.row(row) = x.transpose();
      ++row;
    }
  }
  if (row != part.points.rows()) throw Error("has other key points than its frame", "the object");
  for (const char* name : {"element", "key"})
    part.arrays.push_back(keys.require_array(name, NamedArray::On::points, 1));
  return part;
}

FrameTable edit_table(const std::vector<SceneEdit>& edits) {
  TableBuilder table(
      with_transform_columns({"frame", "element", "kind", "keep", "parameter", "value"}));
  for (int i = 0; i < std::ssize(edits); ++i) {
    const auto& [wish, tag] = edits[i];
    const Delta& delta = wish.delta;
    const double keep = tag ? static_cast<double>(tag->follow) : -1;
    table.add(with_transform({1. + i, 1. * wish.element, static_cast<double>(delta.kind), keep,
                              1. * delta.parameter, delta.value},
                             delta.transform));
  }
  return table.finished();
}

void give_steps(const GrammarScene& scene, Frame& frame) {
  TableBuilder steps({"frame", "kind", "element", "fraction"});
  TableBuilder dabs({"frame", "kind", "x [m]", "y [m]", "z [m]", "radius [m]", "shift_x [m]",
                     "shift_y [m]", "shift_z [m]", "axis_x", "axis_y", "axis_z", "along_x",
                     "along_y", "along_z", "amount"});
  for (std::size_t i = 0; i < scene.steps.size(); ++i) {
    const Step& step = scene.steps[i];
    const auto number = static_cast<double>(i);
    int element = scene.gesture_element;
    if (step.kind == Step::Kind::rest) element = -1;
    if (step.kind == Step::Kind::edit) element = scene.edits[step.number].wish.element;
    steps.add({number, static_cast<double>(step.kind), 1. * element, step.fraction});
    for (const Dab& d : scene.asked_dabs(i))
      dabs.add({number, static_cast<double>(d.kind), d.centre.x(), d.centre.y(), d.centre.z(),
                d.radius, d.shift.x(), d.shift.y(), d.shift.z(), d.axis.x(), d.axis.y(), d.axis.z(),
                d.along.x(), d.along.y(), d.along.z(), d.amount});
  }
  frame.tables["steps"] = steps.finished();
  frame.tables["dabs"] = dabs.finished();
}

}  // namespace

Frame GrammarScene::given() const {
  Frame frame = rest_frame(*this);
  give_types(rest, frame);
  give_steps(*this, frame);
  frame.tables["edits"] = edit_table(edits);
  const Part keys = frame.require_part("keys");
  if (keys.points.rows() * std::ssize(steps) > kMostGiven) return frame;
  for (std::size_t i = 0; i < steps.size(); ++i)
    frame.parts[numbered("asked", static_cast<int>(i))] =
        asked_part(asked_at(*this, i), rest, keys);
  return frame;
}

}  // namespace geoprior::grammar
