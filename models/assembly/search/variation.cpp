#include "models/assembly/search/variation.h"

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "models/assembly/exchange/embedding.h"

namespace geoprior::assembly {

Variation unchanged(const Assembly& model) {
  return {model, std::vector<int>(model.parts.size(), Variation::kKept), 0};
}

Variation varied(const Variation& host, const AssemblySet& set, const Replacement& replacement,
                 Replaced replaced) {
  embed(replaced, set.types);
  Variation out;
  for (std::size_t i = 0; i < host.origin.size(); ++i)
    if (!replacement.removed.parts.has(static_cast<int>(i))) out.origin.push_back(host.origin[i]);
  out.origin.resize(replaced.assembly.parts.size(), replacement.donor);
  out.assembly = std::move(replaced.assembly);
  out.depth = host.depth + 1;
  return out;
}

namespace {

NamedArray cell_array(const char* name, Eigen::Index count) {
  return {name, "1", NamedArray::On::cells, Eigen::MatrixXd(count, 1)};
}

Part surface_part(const Variation& variation, const std::vector<PartType>& types) {
  Eigen::Index vertices = 0, triangles = 0;
  for (const PlacedPart& part : variation.assembly.parts) {
    vertices += types[part.type].mesh.V.rows();
    triangles += types[part.type].mesh.F.rows();
  }
  Part out;
  out.kind = Part::Kind::triangles;
  out.points.resize(vertices, 3);
  out.triangles.resize(triangles, 3);
  NamedArray number = cell_array("part", triangles), label = cell_array("label", triangles),
             exchanged = cell_array("exchanged", triangles);
  vertices = triangles = 0;
  for (std::size_t i = 0; i < variation.assembly.parts.size(); ++i) {
    const PlacedPart& part = variation.assembly.parts[i];
    const TriMesh& mesh = types[part.type].mesh;
    out.points.middleRows(vertices, mesh.V.rows()) =
        (mesh.V * part.pose.linear().transpose()).rowwise() + part.pose.translation().transpose();
    out.triangles.middleRows(triangles, mesh.F.rows()) =
        mesh.F.array() + static_cast<int>(vertices);
    number.values.middleRows(triangles, mesh.F.rows()).setConstant(static_cast<double>(i));
    label.values.middleRows(triangles, mesh.F.rows()).setConstant(part.type);
    exchanged.values.middleRows(triangles, mesh.F.rows())
        .setConstant(variation.origin[i] == Variation::kKept ? 0 : 1);
    vertices += mesh.V.rows();
    triangles += mesh.F.rows();
  }
  out.arrays = {number, label, exchanged};
  return out;
}

/// Middle of a part's ports; of a part without ports its origin.
Eigen::Vector3d centre(const PlacedPart& part, const PartType& type) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PortType& port : type.ports) sum += port.frame.translation();
  if (type.ports.size() > 1) sum /= static_cast<double>(type.ports.size());
  if (type.ports.size() == 1) sum.setZero();
  return part.pose * sum;
}

Part graph_part(const Variation& variation, const std::vector<PartType>& types) {
  const Assembly& assembly = variation.assembly;
  Part out;
  out.kind = Part::Kind::lines;
  out.points.resize(assembly.parts.size(), 3);
  for (std::size_t i = 0; i < assembly.parts.size(); ++i)
    out.points.row(i) = centre(assembly.parts[i], types[assembly.parts[i].type]).transpose();
  NamedArray exchanged = cell_array("exchanged", assembly.connections.size());
  for (std::size_t c = 0; c < assembly.connections.size(); ++c) {
    const auto [a, b] = assembly.connections[c];
    out.lines.push_back({a.part, b.part});
    exchanged.values(c, 0) = variation.origin[a.part] != Variation::kKept ||
                             variation.origin[b.part] != Variation::kKept;
  }
  out.arrays = {exchanged};
  return out;
}

Part joints_part(const Assembly& assembly, const std::vector<PartType>& types) {
  const std::vector<Misfit> misfits = joint_misfits(assembly, types);
  Part out;
  out.kind = Part::Kind::points;
  const auto n = static_cast<Eigen::Index>(misfits.size());
  out.points.resize(n, 3);
  NamedArray gap{"translation", "m", NamedArray::On::points, Eigen::MatrixXd(n, 1)};
  NamedArray angle{"angle", "deg", NamedArray::On::points, Eigen::MatrixXd(n, 1)};
  for (Eigen::Index c = 0; c < n; ++c) {
    const auto [a, b] = assembly.connections[c];
    out.points.row(c) =
        (port_pose(assembly, types, a).translation() + port_pose(assembly, types, b).translation())
            .transpose() /
        2;
    gap.values(c, 0) = misfits[c].translation;
    angle.values(c, 0) = misfits[c].angle * 180 / std::numbers::pi;
  }
  out.arrays = {gap, angle};
  return out;
}

std::vector<std::vector<Eigen::Vector3d>> way_lines(const Assembly& assembly,
                                                    const std::vector<PartType>& types) {
  std::vector<std::vector<Eigen::Vector3d>> lines;
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    bool begins = false;
    for (const Way& way : types[assembly.parts[i].type].ways)
      begins = begins || way.from == Way::kInside;
    if (!begins) continue;
    for (BallWay& way : ball_ways(assembly, types, static_cast<int>(i)))
      lines.push_back(std::move(way.points));
  }
  if (!lines.empty()) return lines;
  for (const PlacedPart& part : assembly.parts)
    for (const Way& way : types[part.type].ways) {
      std::vector<Eigen::Vector3d>& line = lines.emplace_back();
      for (const Eigen::Vector3d& x : way.points) line.push_back(part.pose * x);
    }
  return lines;
}

Part ways_part(const Assembly& assembly, const std::vector<PartType>& types) {
  const auto lines = way_lines(assembly, types);
  Part out;
  out.kind = Part::Kind::lines;
  Eigen::Index points = 0;
  for (const auto& line : lines) points += static_cast<Eigen::Index>(line.size());
  out.points.resize(points, 3);
  points = 0;
  for (const auto& line : lines) {
    std::vector<int>& numbers = out.lines.emplace_back();
    for (const Eigen::Vector3d& x : line) {
      numbers.push_back(static_cast<int>(points));
      out.points.row(points++) = x.transpose();
    }
  }
  return out;
}

constexpr int kPoseNumbers = 12;

FrameTable parts_table(const Variation& variation) {
  FrameTable out;
  out.columns = {"type [1]", "origin [1]"};
  for (int i = 0; i < 9; ++i) out.columns.push_back("rotation_" + std::to_string(i) + " [1]");
  for (int i = 0; i < 3; ++i) out.columns.push_back("translation_" + std::to_string(i) + " [m]");
  const auto n = static_cast<Eigen::Index>(variation.assembly.parts.size());
  out.rows.resize(n, 2 + kPoseNumbers);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PlacedPart& part = variation.assembly.parts[i];
    out.rows(i, 0) = part.type;
    out.rows(i, 1) = variation.origin[i];
    for (int k = 0; k < 9; ++k) out.rows(i, 2 + k) = part.pose.linear()(k / 3, k % 3);
    out.rows.block<1, 3>(i, 11) = part.pose.translation().transpose();
  }
  return out;
}

FrameTable connections_table(const Assembly& assembly) {
  FrameTable out;
  out.columns = {"part_a [1]", "port_a [1]", "part_b [1]", "port_b [1]"};
  out.rows.resize(static_cast<Eigen::Index>(assembly.connections.size()), 4);
  for (std::size_t c = 0; c < assembly.connections.size(); ++c) {
    const auto [a, b] = assembly.connections[c];
    out.rows.row(static_cast<Eigen::Index>(c)) << a.part, a.port, b.part, b.port;
  }
  return out;
}

}  // namespace

Frame assembly_frame(double parameter, const Variation& variation,
                     const std::vector<PartType>& types, const SearchCounts* counts) {
  Frame frame;
  frame.parameter = parameter;
  frame.parts["surface"] = surface_part(variation, types);
  frame.parts["graph"] = graph_part(variation, types);
  frame.parts["joints"] = joints_part(variation.assembly, types);
  frame.parts["ways"] = ways_part(variation.assembly, types);
  frame.tables["parts"] = parts_table(variation);
  frame.tables["connections"] = connections_table(variation.assembly);
  if (counts == nullptr) return frame;
  frame.diagnostics["depth"] = variation.depth;
  frame.diagnostics["candidates"] = counts->candidates;
  frame.diagnostics["closing"] = counts->closing;
  frame.diagnostics["duplicates"] = counts->duplicates;
  frame.diagnostics["valid"] = counts->valid;
  frame.diagnostics["states"] = counts->states;
  for (int f = 0; f < static_cast<int>(Filter::none); ++f)
    frame.diagnostics["broken_" + filter_name(static_cast<Filter>(f))] = counts->broken[f];
  return frame;
}

Variation variation_of(const Frame& frame) {
  const Eigen::MatrixXd& parts = frame.require_table("parts").rows;
  const Eigen::MatrixXd& connections = frame.require_table("connections").rows;
  Variation out;
  for (Eigen::Index i = 0; i < parts.rows(); ++i) {
    PlacedPart& part = out.assembly.parts.emplace_back();
    part.type = static_cast<int>(parts(i, 0));
    for (int k = 0; k < 9; ++k) part.pose.linear()(k / 3, k % 3) = parts(i, 2 + k);
    part.pose.translation() = parts.block<1, 3>(i, 11).transpose();
    out.origin.push_back(static_cast<int>(parts(i, 1)));
  }
  const auto number = [&](Eigen::Index row, int column) {
    return static_cast<int>(connections(row, column));
  };
  for (Eigen::Index c = 0; c < connections.rows(); ++c)
    out.assembly.connections.push_back(
        {{number(c, 0), number(c, 1)}, {number(c, 2), number(c, 3)}});
  return out;
}

}  // namespace geoprior::assembly
