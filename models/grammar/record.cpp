#include "models/grammar/record.h"

#include <algorithm>

namespace geoprior::grammar {
namespace {

/// Vertices and triangles of one element in the world; nothing when it draws nothing.
TriMesh drawn_element(const Hierarchy& hierarchy, int element) {
  const ElementType& type = hierarchy.type(element);
  TriMesh mesh;
  if (const auto own = hierarchy.points(element); !own.empty()) {
    mesh.V.resize(static_cast<int>(own.size()), 3);
    for (std::size_t i = 0; i < own.size(); ++i) mesh.V.row(static_cast<int>(i)) = own[i];
    mesh.F = type.triangles;
    return mesh;
  }
  if (!type.mesh) return mesh;
  mesh = type.mesh(hierarchy.parameters(element));
  const Pose pose = hierarchy.pose(element);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector3d x = mesh.V.row(v);
    mesh.V.row(v) = pose * x;
  }
  return mesh;
}

void add_surfaces(const Hierarchy& hierarchy, Geometry& out) {
  std::vector<std::pair<int, TriMesh>> meshes;
  int vertices = 0, triangles = 0;
  for (int e = 0; e < hierarchy.size(); ++e) {
    if (!hierarchy.present(e)) continue;
    TriMesh mesh = drawn_element(hierarchy, e);
    if (mesh.triangle_count() == 0) continue;
    vertices += mesh.vertex_count();
    triangles += mesh.triangle_count();
    meshes.emplace_back(e, std::move(mesh));
  }
  out.surface.V.resize(vertices, 3);
  out.surface.F.resize(triangles, 3);
  int v = 0, f = 0;
  for (const auto& [element, mesh] : meshes) {
    out.surface.V.middleRows(v, mesh.vertex_count()) = mesh.V;
    out.surface.F.middleRows(f, mesh.triangle_count()) = mesh.F.array() + v;
    out.triangle_element.insert(out.triangle_element.end(), mesh.triangle_count(), element);
    out.vertex_element.insert(out.vertex_element.end(), mesh.vertex_count(), element);
    v += mesh.vertex_count();
    f += mesh.triangle_count();
  }
}

/// An array of one number for each row: `value(row)`.
template <class Value>
NamedArray numbers(std::string name, NamedArray::On on, Eigen::Index rows, Value value) {
  NamedArray array{std::move(name), "1", on, Eigen::MatrixXd(rows, 1)};
  for (Eigen::Index i = 0; i < rows; ++i) array.values(i, 0) = value(static_cast<int>(i));
  return array;
}

Part element_part(const Hierarchy& h) {
  constexpr auto kPoints = NamedArray::On::points;
  std::vector<int> present;
  std::size_t columns = 1;
  for (int e = 0; e < h.size(); ++e)
    if (h.present(e)) present.push_back(e);
  for (const ElementType& type : h.types()) columns = std::max(columns, type.parameters.size());
  const auto n = static_cast<Eigen::Index>(present.size());
  Part part;
  part.kind = Part::Kind::points;
  part.points.resize(n, 3);
  NamedArray turn{"turn", "1", kPoints, Eigen::MatrixXd(n, 4)};
  NamedArray values{"parameters", "1", kPoints,
                    Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(columns))};
  for (Eigen::Index i = 0; i < n; ++i) {
    const int e = present[i];
    part.points.row(i) = h.position(e);
    turn.values.row(i) = h.turn(e).coeffs();
    const auto own = h.parameters(e);
    for (std::size_t p = 0; p < own.size(); ++p)
      values.values(i, static_cast<Eigen::Index>(p)) = own[p];
  }
  part.arrays = {numbers("element", kPoints, n, [&](int i) { return present[i]; }),
                 numbers("type", kPoints, n, [&](int i) { return h.type_number(present[i]); }),
                 numbers("parent", kPoints, n, [&](int i) { return h.parent(present[i]); }),
                 numbers("tagged", kPoints, n, [&](int i) { return h.tag(present[i]) ? 1. : 0.; }),
                 std::move(turn),
                 std::move(values)};
  return part;
}

}  // namespace

Geometry geometry_of(const Hierarchy& hierarchy, bool with_surface) {
  Geometry out;
  std::vector<Eigen::Vector3d> keys;
  for (int e = 0; e < hierarchy.size(); ++e) {
    if (!hierarchy.present(e)) continue;
    const std::size_t before = keys.size();
    hierarchy.keys(e, keys);
    for (std::size_t k = before; k < keys.size(); ++k) {
      out.key_element.push_back(e);
      out.key_number.push_back(static_cast<int>(k - before));
    }
  }
  out.keys.resize(static_cast<int>(keys.size()), 3);
  for (std::size_t k = 0; k < keys.size(); ++k) out.keys.row(static_cast<int>(k)) = keys[k];
  if (with_surface) add_surfaces(hierarchy, out);
  return out;
}

Frame frame_of(double parameter, const Hierarchy& h, const Geometry& geometry) {
  constexpr auto kPoints = NamedArray::On::points;
  constexpr auto kCells = NamedArray::On::cells;
  Frame frame;
  frame.parameter = parameter;
  frame.parts["elements"] = element_part(h);
  Part& keys = frame.parts["keys"];
  keys.kind = Part::Kind::points;
  keys.points = geometry.keys;
  const auto n = geometry.keys.rows();
  const auto element = [&](int k) { return geometry.key_element[k]; };
  keys.arrays = {numbers("element", kPoints, n, element),
                 numbers("key", kPoints, n, [&](int k) { return geometry.key_number[k]; }),
                 numbers("type", kPoints, n, [&](int k) { return h.type_number(element(k)); }),
                 numbers("parent", kPoints, n, [&](int k) { return h.parent(element(k)); })};
  if (geometry.surface.triangle_count() == 0) return frame;
  Part& surface = frame.parts["surface"];
  surface.points = geometry.surface.V;
  surface.triangles = geometry.surface.F;
  const auto cells = geometry.surface.F.rows();
  const auto cell = [&](int f) { return geometry.triangle_element[f]; };
  surface.arrays = {numbers("element", kCells, cells, cell),
                    numbers("type", kCells, cells, [&](int f) { return h.type_number(cell(f)); })};
  return frame;
}

}  // namespace geoprior::grammar
