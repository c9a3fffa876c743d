#include "experiments/embryo/frames/day_frame.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "experiments/embryo/frames/recorded.h"
#include "models/embryo/shape/curve.h"

namespace geoprior::embryo {
namespace {

// Of a recorded centre line: chords are then off the curve by less than 1 % of a duct's radius.
constexpr int kPointsPerSpan = 48;

Part centreline_part(const EmbryoScene& scene, const DayState& state) {
  Part part;
  part.kind = Part::Kind::lines;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii, codes;
  for (const StructureState& one : state.structures) {
    const Shape& shape = one.shape;
    if (shape.primitive != Primitive::duct) continue;
    const std::vector<Eigen::Vector3d> line = Curve(shape.points).polyline(kPointsPerSpan);
    std::vector<int>& indices = part.lines.emplace_back();
    double length = 0, along = 0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (i > 0) along += (line[i] - line[i - 1]).norm();
      const double u = length > 0 ? along / length : 0;
      indices.push_back(static_cast<int>(points.size()));
      points.push_back(line[i]);
      radii.push_back(shape.radius + u * (shape.end_radius - shape.radius));
    }
    codes.push_back(one.structure);
  }
  part.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) part.points.row(i) = points[i].transpose();
  part.arrays.push_back(structure_array(scene, NamedArray::On::cells,
                                        Eigen::VectorXd::Map(codes.data(), std::ssize(codes))));
  part.arrays.push_back({recorded::kRadius, "m", NamedArray::On::points,
                         Eigen::VectorXd::Map(radii.data(), std::ssize(radii))});
  return part;
}

Part landmark_part(const EmbryoScene& scene, const DayState& state) {
  Part part;
  part.kind = Part::Kind::points;
  std::vector<double> codes;
  std::vector<Eigen::Vector3d> points;
  for (const StructureState& one : state.structures) {
    if (one.shape.primitive != Primitive::point) continue;
    points.push_back(one.shape.center);
    codes.push_back(one.structure);
  }
  part.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) part.points.row(i) = points[i].transpose();
  part.arrays.push_back(structure_array(scene, NamedArray::On::points,
                                        Eigen::VectorXd::Map(codes.data(), std::ssize(codes))));
  return part;
}

FrameTable shape_table(const DayState& state) {
  FrameTable table;
  table.columns = {"structure [1]", "primitive [1]", "x [m]",   "y [m]",         "z [m]",
                   "qw [1]",        "qx [1]",        "qy [1]",  "qz [1]",        "a [m]",
                   "b [m]",         "c [m]",         "egg [1]", "branchings [1]"};
  table.rows.resize(std::ssize(state.structures), std::ssize(table.columns));
  for (std::size_t i = 0; i < state.structures.size(); ++i) {
    const Shape& s = state.structures[i].shape;
    Eigen::Quaterniond q(s.axes);
    if (q.w() < 0) q.coeffs() *= -1;
    table.rows.row(i) << state.structures[i].structure, static_cast<int>(s.primitive), s.center.x(),
        s.center.y(), s.center.z(), q.w(), q.x(), q.y(), q.z(), s.radii.x(), s.radii.y(),
        s.radii.z(), s.egg, s.branchings;
  }
  return table;
}

FrameTable process_table(const DayState& state) {
  FrameTable table;
  table.columns = {"process [1]", "active [1]", "progress [1]", "met [1]"};
  table.rows.resize(std::ssize(state.processes), 4);
  for (std::size_t i = 0; i < state.processes.size(); ++i) {
    const ProcessState& p = state.processes[i];
    table.rows.row(i) << p.process, p.active ? 1 : 0, p.progress, p.met ? 1 : 0;
  }
  return table;
}

}  // namespace

NamedArray structure_array(const EmbryoScene& scene, NamedArray::On on, Eigen::VectorXd codes) {
  return {recorded::kStructure, "1", on, std::move(codes), scene.structure_labels};
}

Part surface_part(const EmbryoScene& scene, const std::vector<StructureMesh>& meshes) {
  Part part;
  Eigen::Index vertices = 0, triangles = 0;
  for (const StructureMesh& one : meshes) {
    vertices += one.mesh.V.rows();
    triangles += one.mesh.F.rows();
  }
  part.points.resize(vertices, 3);
  part.triangles.resize(triangles, 3);
  Eigen::VectorXd structure(triangles), kind(triangles);
  Eigen::Index v = 0, t = 0;
  for (const StructureMesh& one : meshes) {
    part.points.middleRows(v, one.mesh.V.rows()) = one.mesh.V;
    for (Eigen::Index i = 0; i < one.mesh.F.rows(); ++i) {
      part.triangles.row(t + i) = one.mesh.F.row(i).array() + static_cast<int>(v);
      structure[t + i] = one.structure_of_triangle[i];
      kind[t + i] = scene.kind_of_structure[one.structure_of_triangle[i]];
    }
    v += one.mesh.V.rows();
    t += one.mesh.F.rows();
  }
  part.arrays.push_back(structure_array(scene, NamedArray::On::cells, std::move(structure)));
  part.arrays.push_back(
      {recorded::kKind, "1", NamedArray::On::cells, std::move(kind), scene.kind_names});
  return part;
}

Frame day_frame(const EmbryoScene& scene, const DayState& state,
                const std::vector<StructureMesh>& meshes) {
  Frame frame;
  frame.parameter = state.day;
  frame.parts[recorded::kSurface] = surface_part(scene, meshes);
  frame.parts[recorded::kCentrelines] = centreline_part(scene, state);
  frame.parts[recorded::kLandmarks] = landmark_part(scene, state);
  frame.tables[recorded::kShapes] = shape_table(state);
  frame.tables[recorded::kProcesses] = process_table(state);
  FrameTable body;
  body.columns = {"crown_rump_length [m]"};
  body.rows = Eigen::MatrixXd::Constant(1, 1, state.crown_rump_length);
  frame.tables[recorded::kBody] = std::move(body);
  return frame;
}

DayState wanted(const EmbryoScene& scene, const DayState& state) {
  DayState some = state;
  std::erase_if(some.structures,
                [&](const StructureState& one) { return !scene.meshed[one.structure]; });
  std::erase_if(some.halves, [&](const auto& half) { return !scene.meshed[half.product]; });
  for (auto& group : some.fused)
    std::erase_if(group.members, [&](int member) { return !scene.meshed[member]; });
  return some;
}

}  // namespace geoprior::embryo
