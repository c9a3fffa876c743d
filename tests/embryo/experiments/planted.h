#pragma once

#include <string>
#include <vector>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/scene/scene.h"

namespace geoprior::embryo::planted {

/// A scene of structures without keys, of which frames are made by hand.
inline EmbryoScene scene_of(const std::vector<std::string>& names,
                            const std::vector<std::string>& sides = {}) {
  EmbryoScene scene;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Structure one;
    one.name = names[i];
    one.side = sides.empty() ? "median" : sides[i];
    one.kind = "organ";
    scene.ontology.structures.push_back(one);
    scene.structure_names.push_back(names[i]);
    scene.kind_of_structure.push_back(0);
  }
  scene.kind_names = {"organ"};
  scene.meshed.assign(names.size(), true);
  scene.healthy_effects.absent.assign(names.size(), false);
  return scene;
}

/// A closed box between two corners, outward oriented.
inline TriMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i) {
    mesh.V.row(i) << ((i & 1) != 0 ? high : low).x(), ((i & 2) != 0 ? high : low).y(),
        ((i & 4) != 0 ? high : low).z();
  }
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6,
      2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

/// A frame whose body is one long, without structures.
inline Frame empty_frame(double day) {
  Frame frame;
  frame.parameter = day;
  Part& surface = frame.parts[recorded::kSurface];
  surface.arrays.push_back(
      {recorded::kStructure, "1", NamedArray::On::cells, Eigen::MatrixXd(0, 1)});
  FrameTable& body = frame.tables[recorded::kBody];
  body.columns = {"crown_rump_length [m]"};
  body.rows = Eigen::MatrixXd::Ones(1, 1);
  FrameTable& shapes = frame.tables[recorded::kShapes];
  shapes.columns.resize(14, "column");
  shapes.rows.resize(0, 14);
  return frame;
}

inline void add_surface(Frame& frame, int structure, const TriMesh& mesh) {
  Part& part = frame.parts.at(recorded::kSurface);
  const Eigen::Index v = part.points.rows(), t = part.triangles.rows();
  part.points.conservativeResize(v + mesh.V.rows(), 3);
  part.points.bottomRows(mesh.V.rows()) = mesh.V;
  part.triangles.conservativeResize(t + mesh.F.rows(), 3);
  part.triangles.bottomRows(mesh.F.rows()) = mesh.F.array() + static_cast<int>(v);
  Eigen::MatrixXd& codes = part.arrays.front().values;
  codes.conservativeResize(t + mesh.F.rows(), 1);
  codes.bottomRows(mesh.F.rows()).setConstant(structure);
}

/// Axes along the body's.
inline void add_shape(Frame& frame, int structure, Primitive primitive,
                      const Eigen::Vector3d& center, const Eigen::Vector3d& radii) {
  Eigen::MatrixXd& rows = frame.tables.at(recorded::kShapes).rows;
  rows.conservativeResize(rows.rows() + 1, 14);
  rows.bottomRows(1) << structure, static_cast<int>(primitive), center.x(), center.y(), center.z(),
      1, 0, 0, 0, radii.x(), radii.y(), radii.z(), 0, 0;
}

inline void add_line(Frame& frame, int structure, const Eigen::MatrixX3d& points, double radius) {
  Part& part = frame.parts[recorded::kCentrelines];
  part.kind = Part::Kind::lines;
  if (part.arrays.empty()) {
    part.arrays.push_back(
        {recorded::kStructure, "1", NamedArray::On::cells, Eigen::MatrixXd(0, 1)});
    part.arrays.push_back({recorded::kRadius, "m", NamedArray::On::points, Eigen::MatrixXd(0, 1)});
  }
  const Eigen::Index first = part.points.rows();
  part.points.conservativeResize(first + points.rows(), 3);
  part.points.bottomRows(points.rows()) = points;
  std::vector<int>& line = part.lines.emplace_back();
  for (Eigen::Index i = 0; i < points.rows(); ++i) line.push_back(static_cast<int>(first + i));
  Eigen::MatrixXd& codes = part.arrays[0].values;
  codes.conservativeResize(codes.rows() + 1, 1);
  codes.bottomRows(1).setConstant(structure);
  Eigen::MatrixXd& radii = part.arrays[1].values;
  radii.conservativeResize(first + points.rows(), 1);
  radii.bottomRows(points.rows()).setConstant(radius);
}

}  // namespace geoprior::embryo::planted
