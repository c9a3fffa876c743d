#include "experiments/assembly/scene/given.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "models/assembly/graph/compatibility.h"
#include "models/assembly/search/variation.h"
#include "testbed/given_tables.h"

namespace geoprior::assembly {
namespace {

/// The bodies of all kinds, each in its own coordinates: the surface of an assembly with one part
/// of each kind, none of them moved.
Part given_bodies(const std::vector<PartType>& types) {
  Assembly one_of_each;
  std::vector<std::string> labels;
  for (int t = 0; t < std::ssize(types); ++t) {
    one_of_each.parts.push_back({t, Pose::Identity()});
    labels.push_back(types[t].label);
  }
  Part part = assembly_frame(0, unchanged(one_of_each), types, nullptr).require_part("surface");
  std::erase_if(part.arrays, [](const NamedArray& array) { return array.name != "label"; });
  part.arrays.at(0).names = std::move(labels);
  return part;
}

Part given_ways(const std::vector<PartType>& types) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<Eigen::RowVector3d> of_way;
  for (int t = 0; t < std::ssize(types); ++t) {
    for (const Way& way : types[t].ways) {
      const Eigen::Index first = part.points.rows();
      part.points.conservativeResize(first + std::ssize(way.points), 3);
      std::vector<int>& line = part.lines.emplace_back();
      for (const Eigen::Vector3d& x : way.points) {
        line.push_back(static_cast<int>(first) + static_cast<int>(line.size()));
        part.points.row(line.back()) = x.transpose();
      }
      of_way.emplace_back(t, way.from, way.to);
    }
  }
  for (const auto& [name, column] :
       {std::pair("type", 0), std::pair("from", 1), std::pair("to", 2)}) {
    NamedArray array{name, "1", NamedArray::On::cells, Eigen::MatrixXd(std::ssize(of_way), 1)};
    for (Eigen::Index w = 0; w < array.values.rows(); ++w) array.values(w, 0) = of_way[w][column];
    part.arrays.push_back(std::move(array));
  }
  return part;
}

void give_kinds(const AssemblySet& set, Frame& frame) {
  const Compatibility compatibility(set, true);
  TableBuilder ports(with_transform_columns({"type", "port", "class"}));
  TableBuilder boxes(with_transform_columns({"type", "half_x [m]", "half_y [m]", "half_z [m]"}));
  TableBuilder symmetries(with_transform_columns({"type"}));
  for (int t = 0; t < std::ssize(set.types); ++t) {
    const PartType& type = set.types[t];
    for (int p = 0; p < std::ssize(type.ports); ++p) {
      const int alike = compatibility.port_class(t, p);
      ports.add(with_transform({1. * t, 1. * p, 1. * alike}, Eigen::Affine3d(type.ports[p].frame)));
    }
    for (const Box& box : type.boxes) {
      const Eigen::Vector3d& h = box.half;
      boxes.add(with_transform({1. * t, h.x(), h.y(), h.z()}, Eigen::Affine3d(box.pose)));
    }
    for (const Symmetry& symmetry : type.symmetries)
      symmetries.add(with_transform({1. * t}, Eigen::Affine3d(symmetry.motion)));
  }
  frame.tables["ports"] = ports.finished();
  frame.tables["boxes"] = boxes.finished();
  frame.tables["symmetries"] = symmetries.finished();
}

/// Tables of one kind, one below the other, each row with the number of its table before it.
FrameTable stacked(const std::vector<FrameTable>& tables, const std::string& number) {
  FrameTable out;
  out.columns = tables.front().columns;
  out.columns.insert(out.columns.begin(), number);
  Eigen::Index rows = 0;
  for (const FrameTable& table : tables) rows += table.rows.rows();
  out.rows.resize(rows, std::ssize(out.columns));
  rows = 0;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const Eigen::MatrixXd& own = tables[i].rows;
    out.rows.block(rows, 0, own.rows(), 1).setConstant(static_cast<double>(i));
    out.rows.block(rows, 1, own.rows(), own.cols()) = own;
    rows += own.rows();
  }
  return out;
}

}  // namespace

Frame given_frame(const AssemblyInput& input) {
  Frame frame;
  frame.parts["bodies"] = given_bodies(input.set.types);
  frame.parts["ways"] = given_ways(input.set.types);
  give_kinds(input.set, frame);
  std::map<std::string, std::vector<FrameTable>> of_models;
  for (const Assembly& model : input.set.models) {
    const Frame of_model = assembly_frame(0, unchanged(model), input.set.types, nullptr);
    for (const auto& [name, table] : of_model.tables) of_models[name].push_back(table);
  }
  for (const auto& [name, tables] : of_models) frame.tables[name] = stacked(tables, "model");
  return frame;
}

}  // namespace geoprior::assembly
