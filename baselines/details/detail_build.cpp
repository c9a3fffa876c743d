#include <algorithm>
#include <numeric>
#include <utility>

#include "baselines/details/detail_mesh.h"
#include "baselines/details/triangle_filler.h"
#include "core/random.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Details become vertices n_surface, n_surface + 1, …
void insert_details(IntrinsicTriangulation& mesh, std::span<const Detail> details,
                    std::vector<int>& vertex) {
  std::vector<int> order(details.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return details[index(a)].at.face < details[index(b)].at.face;
  });
  vertex.resize(details.size());
  for (std::size_t i = 0; i < order.size();) {
    const int face = details[index(order[i])].at.face;
    TriangleFiller filler(mesh, face);
    for (; i < order.size() && details[index(order[i])].at.face == face; ++i)
      vertex[index(order[i])] = filler.insert(details[index(order[i])].at.barycentric);
  }
}

/// Takes the surface's own vertices out, in an order without pattern, until those that remain hold
/// the topology.
void remove_surface_vertices(IntrinsicTriangulation& mesh, int count,
                             std::span<const Eigen::Vector3d> position) {
  std::vector<int> left(index(count));
  std::iota(left.begin(), left.end(), 0);
  RandomStream random(1, "order of removal");
  for (std::size_t i = left.size(); i > 1; --i)
    std::swap(left[i - 1], left[random.below(static_cast<std::uint32_t>(i))]);
  for (std::size_t before = left.size() + 1; before > left.size();) {
    before = left.size();
    std::erase_if(left, [&](int v) { return mesh.remove(v, position); });
  }
}

SurfacePoint point_of_vertex(int v, const SurfaceTopology& surface) {
  const int f = surface.faces_of(v)[0];
  SurfacePoint p{f, Eigen::Vector3d::Zero()};
  for (Eigen::Index k = 0; k < 3; ++k)
    p.barycentric[k] = surface.face[index(f)][static_cast<std::size_t>(k)] == v ? 1 : 0;
  return p;
}

/// Numbers details first, in their order, then ghosts.
void number_sites(DetailMesh& result, std::span<const Detail> details,
                  std::span<const int> vertex_of_detail, int surface_vertices) {
  std::vector<int> number(index(result.mesh.vertex_slots()), -1);
  result.site.assign(details.begin(), details.end());
  for (std::size_t i = 0; i < details.size(); ++i)
    number[index(vertex_of_detail[i])] = static_cast<int>(i);
  for (int v = 0; v < surface_vertices; ++v) {
    if (!result.mesh.vertex_alive(v)) continue;
    number[index(v)] = static_cast<int>(result.site.size());
    Detail ghost;
    ghost.at = point_of_vertex(v, *result.surface);
    ghost.weight = ghost.target_weight = 0;
    ghost.birth = -1;
    result.site.push_back(ghost);
  }
  result.kind.assign(result.site.size(), SiteKind::ghost);
  std::fill_n(result.kind.begin(), details.size(), SiteKind::detail);
  result.mesh.renumber(number);
}

/// Every triangle holds what it has now.
void set_rest_densities(DetailMesh& d) {
  for (int t = 0; t < d.mesh.triangle_slots(); ++t) {
    if (!d.mesh.triangle_alive(t)) continue;
    const double area = d.mesh.area(t);
    d.mesh.set_density(t, area > 0 ? details_of(d, t) / area : 0);
  }
}

}  // namespace

DetailMesh build_detail_mesh(std::shared_ptr<const SurfaceTopology> surface,
                             std::span<const Eigen::Vector3d> x, std::span<const Detail> details) {
  DetailMesh result;
  result.surface = std::move(surface);
  result.x.assign(x.begin(), x.end());
  result.mesh = IntrinsicTriangulation(result.surface->face, x);
  std::vector<int> vertex;
  insert_details(result.mesh, details, vertex);
  std::vector<Eigen::Vector3d> position(index(result.mesh.vertex_slots()));
  std::copy(x.begin(), x.end(), position.begin());
  for (std::size_t i = 0; i < details.size(); ++i)
    position[index(vertex[i])] = position_of(details[i].at, *result.surface, x);
  result.mesh.flip_to_delaunay();
  const int surface_vertices = static_cast<int>(x.size());
  remove_surface_vertices(result.mesh, surface_vertices, position);
  number_sites(result, details, vertex, surface_vertices);
  result.position.clear();
  for (const Detail& d : result.site)
    result.position.push_back(position_of(d.at, *result.surface, x));
  result.mesh.measure(result.position);
  result.mesh.flip_to_delaunay();
  set_rest_densities(result);
  return result;
}

DetailMesh build_detail_mesh(const TriMesh& rest, std::span<const Detail> details) {
  std::vector<Eigen::Vector3d> x(index(rest.vertex_count()));
  for (Eigen::Index v = 0; v < rest.V.rows(); ++v)
    x[static_cast<std::size_t>(v)] = rest.V.row(v).transpose();
  std::vector<Detail> sites(details.begin(), details.end());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sites[i].birth = static_cast<std::int64_t>(i);
    sites[i].birth_frame = sites[i].generation = 0;
  }
  DetailMesh result = build_detail_mesh(std::make_shared<SurfaceTopology>(rest), x, sites);
  result.births = static_cast<std::int64_t>(sites.size());
  return result;
}

}  // namespace geoprior
