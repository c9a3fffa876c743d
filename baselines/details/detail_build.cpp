#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "baselines/details/detail_mesh.h"
#include "core/error.h"
#include "core/random.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// A triangle of a face that is being filled with details, in barycentric coordinates of the face.
struct Piece {
  std::array<Eigen::Vector3d, 3> corner;
  int triangle = 0;
  int child = -1;  ///< first of three
};

/// Coordinates of a point of the face with respect to a piece.
Eigen::Vector3d local_coordinates(const Piece& piece, const Eigen::Vector3d& b) {
  Eigen::Matrix3d corners;
  corners << piece.corner[0], piece.corner[1], piece.corner[2];
  return corners.inverse() * b;
}

/// Puts the details of one face into the triangulation, each into the piece that holds it.
/// Vertices on the rim of a piece are moved inside by a hair: connectivity is all that is wanted.
class FaceFiller {
 public:
  FaceFiller(IntrinsicTriangulation& mesh, int face) : mesh_(mesh) {
    pieces_.push_back(
        {{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}, face, -1});
  }

  int insert(const Eigen::Vector3d& b) {
    std::size_t at = 0;
    Eigen::Vector3d local = local_coordinates(pieces_[0], b);
    while (pieces_[at].child >= 0) {
      const std::size_t first = index(pieces_[at].child);
      std::size_t best = first;
      for (std::size_t c = first; c < first + 3; ++c) {
        const Eigen::Vector3d inside = local_coordinates(pieces_[c], b);
        if (c == first || inside.minCoeff() > local.minCoeff()) {
          best = c;
          local = inside;
        }
      }
      at = best;
    }
    local = local.cwiseMax(kInside);
    local /= local.sum();
    return split(at, local);
  }

 private:
  static constexpr double kInside = 1e-5;

  int split(std::size_t at, const Eigen::Vector3d& local) {
    const Piece parent = pieces_[at];
    const Eigen::Vector3d p =
        local[0] * parent.corner[0] + local[1] * parent.corner[1] + local[2] * parent.corner[2];
    const int v = mesh_.insert(parent.triangle, local, false);
    pieces_[at].child = static_cast<int>(pieces_.size());
    const int last = mesh_.triangle_slots() - 1;  // the order that `insert` makes them in
    pieces_.push_back({{parent.corner[0], parent.corner[1], p}, parent.triangle, -1});
    pieces_.push_back({{parent.corner[1], parent.corner[2], p}, last - 1, -1});
    pieces_.push_back({{parent.corner[2], parent.corner[0], p}, last, -1});
    return v;
  }

  IntrinsicTriangulation& mesh_;
  std::vector<Piece> pieces_;
};

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
    FaceFiller filler(mesh, face);
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
  for (int t = 0; t < result.mesh.triangle_slots(); ++t) {
    if (!result.mesh.triangle_alive(t)) continue;
    const double area = result.mesh.area(t);
    result.mesh.set_density(t, area > 0 ? 0.5 / area : 0);
  }
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
