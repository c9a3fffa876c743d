#include "baselines/details/detail_mesh.h"

#include <algorithm>
#include <cmath>

#include "baselines/details/triangle_filler.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

void place_sites(DetailMesh& d) {
  parallel_blocks(d.site.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (d.kind[i] != SiteKind::empty) d.position[i] = position_of(d.site[i].at, *d.surface, d.x);
    }
  });
}

/// Number for a new vertex of the mesh: its site, empty so far.
void make_room(DetailMesh& d, int v) {
  if (v < d.site_slots()) return;
  d.site.resize(index(v) + 1);
  d.kind.resize(index(v) + 1, SiteKind::empty);
  d.position.resize(index(v) + 1, Eigen::Vector3d::Zero());
}

}  // namespace

int DetailMesh::detail_count() const {
  return static_cast<int>(std::count(kind.begin(), kind.end(), SiteKind::detail));
}

int DetailMesh::ghost_count() const {
  return static_cast<int>(std::count(kind.begin(), kind.end(), SiteKind::ghost));
}

void DetailMesh::save(StateWriter& out) const {
  out.items(x);
  out.number(site.size());
  for (const Detail& d : site) {
    out.number(d.at.face);
    out.matrix(d.at.barycentric);
    out.number(d.weight);
    out.number(d.target_weight);
    out.number(d.tangent_angle);
    out.number(d.type);
    out.number(d.birth);
    out.number(d.birth_frame);
    out.number(d.generation);
  }
  out.items(kind);
  out.items(position);
  mesh.save(out);
  out.number(births);
  out.number(frame);
}

void DetailMesh::load(StateReader& in) {
  in.items(x);
  site.assign(in.number<std::size_t>(), {});
  for (Detail& d : site) {
    d.at.face = in.number<int>();
    in.matrix(d.at.barycentric);
    d.weight = in.number<double>();
    d.target_weight = in.number<double>();
    d.tangent_angle = in.number<double>();
    d.type = in.number<int>();
    d.birth = in.number<std::int64_t>();
    d.birth_frame = in.number<int>();
    d.generation = in.number<int>();
  }
  in.items(kind);
  in.items(position);
  mesh.load(in);
  births = in.number<std::int64_t>();
  frame = in.number<int>();
}

void measure_edges(DetailMesh& d, LengthRule rule) {
  if (rule == LengthRule::geodesic)
    measure_sections(d);
  else
    d.mesh.measure(d.position);
}

bool surface_differs(const DetailMesh& d, const Eigen::MatrixX3d& V) {
  for (std::size_t v = 0; v < d.x.size(); ++v)
    if (d.x[v] != V.row(static_cast<Eigen::Index>(v)).transpose()) return true;
  return false;
}

int move_surface(DetailMesh& d, const Eigen::MatrixX3d& V, LengthRule rule) {
  ++d.frame;
  if (!surface_differs(d, V)) return 0;  // nothing is measured anew, so that nothing changes
  parallel_blocks(d.x.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      d.x[v] = V.row(static_cast<Eigen::Index>(v)).transpose();
  });
  place_sites(d);
  measure_edges(d, rule);
  return d.mesh.flip_to_delaunay();
}

SurfacePoint surface_point_in(const DetailMesh& d, int t, const Eigen::Vector3d& barycentric) {
  const auto corner = d.mesh.corners(t);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    target += barycentric[static_cast<Eigen::Index>(k)] * d.position[index(corner[k])];
  Eigen::Index nearest = 0;
  barycentric.maxCoeff(&nearest);
  return walk_to_nearest(d.site[index(corner[static_cast<std::size_t>(nearest)])].at, target,
                         *d.surface, d.x);
}

std::vector<int> insert_details(DetailMesh& d, int t, std::span<const NewDetail> born) {
  int generation = 0;
  for (const int c : d.mesh.corners(t))
    if (d.is_detail(c)) generation = std::max(generation, d.site[index(c)].generation);
  TriangleFiller filler(d.mesh, t);
  std::vector<int> sites;
  for (const NewDetail& one : born) {
    const int v = filler.insert(one.barycentric);
    make_room(d, v);
    Detail& site = d.site[index(v)];
    site = one.like;
    site.at = one.at;
    site.birth = d.births++;
    site.birth_frame = d.frame;
    site.generation = generation + 1;
    d.kind[index(v)] = SiteKind::detail;
    d.position[index(v)] = position_of(one.at, *d.surface, d.x);
    sites.push_back(v);
  }
  d.mesh.flip_around(sites);
  return sites;
}

int insert_detail(DetailMesh& d, int t, const Eigen::Vector3d& barycentric, const Detail& like) {
  const NewDetail born{barycentric, surface_point_in(d, t, barycentric), like};
  return insert_details(d, t, {&born, 1})[0];
}

void remove_detail(DetailMesh& d, int site) {
  if (d.mesh.remove(site, d.position)) {
    d.kind[index(site)] = SiteKind::empty;
    return;
  }
  d.kind[index(site)] = SiteKind::ghost;
  d.site[index(site)].weight = d.site[index(site)].target_weight = 0;
}

double change_weights(DetailMesh& d, double most) {
  double largest = 0;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i)) continue;
    Detail& detail = d.site[index(i)];
    const double missing = detail.target_weight - detail.weight;
    if (missing != 0) {
      const double change = std::clamp(missing, -most, most);
      // Ten steps of 0.1 end on 1, not on 1 - 1e-16.
      detail.weight =
          std::abs(missing) <= most * (1 + 1e-9) ? detail.target_weight : detail.weight + change;
      largest = std::max(largest, std::abs(change));
    }
    if (detail.weight == 0 && detail.target_weight == 0) remove_detail(d, i);
  }
  return largest;
}

double details_of(const DetailMesh& d, int t) {
  int corners = 0;
  for (const int c : d.mesh.corners(t)) corners += d.is_detail(c) ? 1 : 0;
  return std::max(corners, 1) / 6.0;
}

bool among_details(const DetailMesh& d, int h) {
  const auto apex_is_detail = [&](int half) {
    return half >= 0 && d.is_detail(d.mesh.origin(IntrinsicTriangulation::previous(half)));
  };
  return d.is_detail(d.mesh.origin(h)) && d.is_detail(d.mesh.tip(h)) && apex_is_detail(h) &&
         apex_is_detail(d.mesh.twin(h));
}

double mean_edge(const DetailMesh& d) {
  double sum = 0;
  std::int64_t count = 0;
  for (int h = 0; h < 3 * d.mesh.triangle_slots(); ++h) {
    if (d.mesh.origin(h) < 0 || d.mesh.twin(h) > h || !among_details(d, h)) continue;
    sum += d.mesh.length(h);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

std::vector<std::array<int, 3>> visible_triangles(const DetailMesh& d, double weight) {
  IntrinsicTriangulation mesh = d.mesh;
  for (int i = 0; i < d.site_slots(); ++i)
    if (d.is_detail(i) && !(d.site[index(i)].weight > weight)) mesh.remove(i, d.position);
  return mesh.triangles();
}

}  // namespace geoprior
