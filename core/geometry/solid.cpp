#include "core/geometry/solid.h"

#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <utility>
#include <vector>

#include "core/geometry/solid_data.h"

namespace geoprior {

namespace pmp = CGAL::Polygon_mesh_processing;
using SolidMesh = decltype(SolidData::mesh);

std::optional<Solid> Solid::of(const TriMesh& mesh) {
  auto data = std::make_unique<SolidData>();
  std::vector<SolidMesh::Vertex_index> ids;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    ids.push_back(data->mesh.add_vertex({mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)}));
  }
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const auto id = [&](int k) { return ids[mesh.F(t, k)]; };
    if (data->mesh.add_face(id(0), id(1), id(2)) == SolidMesh::null_face()) return std::nullopt;
  }
  return Solid(std::move(data));
}

Solid::Solid(std::unique_ptr<SolidData> data) : data_(std::move(data)) {}
Solid::Solid(Solid&& other) noexcept = default;
Solid& Solid::operator=(Solid&& other) noexcept = default;
Solid::~Solid() = default;

bool Solid::bounds_volume() const {
  const SolidMesh& mesh = data_->mesh;
  return CGAL::is_closed(mesh) && !pmp::does_self_intersect(mesh) && pmp::does_bound_a_volume(mesh);
}

bool Solid::empty() const { return data_->mesh.is_empty(); }

double Solid::area() const { return CGAL::to_double(pmp::area(data_->mesh)); }

TriMesh Solid::mesh() const {
  const SolidMesh& from = data_->mesh;
  TriMesh result;
  std::vector<int> ids(from.num_vertices(), -1);  // with those that were removed
  result.V.resize(from.number_of_vertices(), 3);
  int next = 0;
  for (const auto v : from.vertices()) {
    const auto& p = from.point(v);
    result.V.row(next) << p.x(), p.y(), p.z();
    ids[v] = next++;
  }
  result.F.resize(from.number_of_faces(), 3);
  Eigen::Index t = 0;
  for (const auto f : from.faces()) {
    int k = 0;
    for (const auto v : from.vertices_around_face(from.halfedge(f))) result.F(t, k++) = ids[v];
    ++t;
  }
  return result;
}

std::optional<Solid> united(Solid a, Solid b) {
  auto result = std::make_unique<SolidData>();
  const bool made = pmp::corefine_and_compute_union(a.data().mesh, b.data().mesh, result->mesh);
  return made ? std::optional(Solid(std::move(result))) : std::nullopt;
}

std::optional<Solid> common(Solid a, Solid b) {
  auto result = std::make_unique<SolidData>();
  const bool made =
      pmp::corefine_and_compute_intersection(a.data().mesh, b.data().mesh, result->mesh);
  return made ? std::optional(Solid(std::move(result))) : std::nullopt;
}

}  // namespace geoprior
