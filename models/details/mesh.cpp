#include "models/details/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "core/parallel.h"
#include "core/random.h"
#include "models/details/triangle_filler.h"

namespace geoprior::details {
namespace {

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
  d.site.resize(static_cast<std::size_t>(v) + 1);
  d.kind.resize(static_cast<std::size_t>(v) + 1, SiteKind::empty);
  d.position.resize(static_cast<std::size_t>(v) + 1, Eigen::Vector3d::Zero());
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
  site.assign(in.count(), {});
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

void describe_lengths(OptionVisitor& v, LengthRule& rule) {
  static constexpr std::array<std::string_view, 2> kNames{"chord", "geodesic"};
  describe_choice(v, "lengths", rule, kNames,
                  {.doc = "edges of M_d are measured between their ends, or along the surface"});
}

void measure_edges(DetailMesh& d, LengthRule rule) {
  if (rule == LengthRule::geodesic)
    measure_sections(d);
  else
    d.mesh.measure(d.position);
}

bool surface_differs(const DetailMesh& d, const Eigen::MatrixX3d& V) {
  for (std::size_t v = 0; v < d.x.size(); ++v)
    if (d.x[v] != V.row(v).transpose()) return true;
  return false;
}

int move_surface(DetailMesh& d, const Eigen::MatrixX3d& V, LengthRule rule) {
  ++d.frame;
  if (!surface_differs(d, V)) return 0;  // nothing is measured anew, so that nothing changes
  parallel_blocks(d.x.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) d.x[v] = V.row(v).transpose();
  });
  place_sites(d);
  measure_edges(d, rule);
  return d.mesh.flip_to_delaunay();
}

SurfacePoint surface_point_in(const DetailMesh& d, int t, const Eigen::Vector3d& barycentric) {
  const auto corner = d.mesh.corners(t);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) target += barycentric[k] * d.position[corner[k]];
  Eigen::Index nearest = 0;
  barycentric.maxCoeff(&nearest);
  return walk_to_nearest(d.site[corner[nearest]].at, target, *d.surface, d.x);
}

std::vector<int> insert_details(DetailMesh& d, int t, std::span<const NewDetail> born) {
  int generation = 0;
  for (const int c : d.mesh.corners(t))
    if (d.is_detail(c)) generation = std::max(generation, d.site[c].generation);
  TriangleFiller filler(d.mesh, t);
  std::vector<int> sites;
  for (const NewDetail& one : born) {
    const int v = filler.insert(one.barycentric);
    make_room(d, v);
    Detail& site = d.site[v];
    site = one.like;
    site.at = one.at;
    site.birth = d.births++;
    site.birth_frame = d.frame;
    site.generation = generation + 1;
    d.kind[v] = SiteKind::detail;
    d.position[v] = position_of(one.at, *d.surface, d.x);
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
    d.kind[site] = SiteKind::empty;
    return;
  }
  d.kind[site] = SiteKind::ghost;
  d.site[site].weight = d.site[site].target_weight = 0;
}

double change_weights(DetailMesh& d, double most) {
  double largest = 0;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i)) continue;
    Detail& detail = d.site[i];
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

double total_area(const DetailMesh& d) {
  double area = 0;
  for (int t = 0; t < d.mesh.triangle_slots(); ++t)
    if (d.mesh.triangle_alive(t)) area += d.mesh.area(t);
  return area;
}

std::vector<std::array<int, 3>> visible_triangles(const DetailMesh& d, double weight) {
  IntrinsicTriangulation mesh = d.mesh;
  for (int i = 0; i < d.site_slots(); ++i)
    if (d.is_detail(i) && !(d.site[i].weight > weight)) mesh.remove(i, d.position);
  return mesh.triangles();
}

namespace {

/// Details become vertices n_surface, n_surface + 1, …
void insert_details(IntrinsicTriangulation& mesh, std::span<const Detail> details,
                    std::vector<int>& vertex) {
  std::vector<int> order(details.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return details[a].at.face < details[b].at.face; });
  vertex.resize(details.size());
  for (std::size_t i = 0; i < order.size();) {
    const int face = details[order[i]].at.face;
    TriangleFiller filler(mesh, face);
    for (; i < order.size() && details[order[i]].at.face == face; ++i)
      vertex[order[i]] = filler.insert(details[order[i]].at.barycentric);
  }
}

/// Takes the surface's own vertices out, in an order without pattern, until those that remain hold
/// the topology. The order is not the experiment's chance but the same in all runs: whoever asks,
/// method or metric, has one triangulation of the same details.
void remove_surface_vertices(IntrinsicTriangulation& mesh, int count,
                             std::span<const Eigen::Vector3d> position) {
  std::vector<int> left(count);
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
  const int corner = surface.corners_of(v)[0];
  return {corner / 3, Eigen::Vector3d::Unit(corner % 3)};
}

/// Numbers details first, in their order, then ghosts.
void number_sites(DetailMesh& result, std::span<const Detail> details,
                  std::span<const int> vertex_of_detail, int surface_vertices) {
  std::vector<int> number(result.mesh.vertex_slots(), -1);
  result.site.assign(details.begin(), details.end());
  for (int i = 0; i < std::ssize(details); ++i) number[vertex_of_detail[i]] = i;
  for (int v = 0; v < surface_vertices; ++v) {
    if (!result.mesh.vertex_alive(v)) continue;
    number[v] = static_cast<int>(result.site.size());
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
  std::vector<Eigen::Vector3d> position(result.mesh.vertex_slots());
  std::copy(x.begin(), x.end(), position.begin());
  for (std::size_t i = 0; i < details.size(); ++i)
    position[vertex[i]] = position_of(details[i].at, *result.surface, x);
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
  std::vector<Eigen::Vector3d> x(rest.vertex_count());
  for (Eigen::Index v = 0; v < rest.V.rows(); ++v) x[v] = rest.V.row(v).transpose();
  std::vector<Detail> sites(details.begin(), details.end());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    sites[i].birth = i;
    sites[i].birth_frame = sites[i].generation = 0;
  }
  DetailMesh result = build_detail_mesh(std::make_shared<SurfaceTopology>(rest), x, sites);
  result.births = sites.size();
  return result;
}

namespace {

/// Walks from one anchor to another through the faces that a plane cuts.
class Section {
 public:
  Section(const DetailMesh& d, int from, int to)
      : d_(d), from_(d.site[from].at), to_(d.site[to].at) {
    start_ = d.position[from];
    end_ = d.position[to];
    chord_ = (end_ - start_).norm();
    const Eigen::Vector3d up =
        normal_of_face(from_.face, *d.surface, d.x) + normal_of_face(to_.face, *d.surface, d.x);
    side_ = up.cross(end_ - start_);
  }

  /// Length of the section; that of the chord where the walk does not arrive.
  [[nodiscard]] double length() const {
    if (from_.face == to_.face || !(side_.squaredNorm() > 0)) return chord_;
    Eigen::Vector3d at = start_;
    double sum = 0;
    int face = from_.face, came_from = -1;
    for (int steps = 0; steps < 4096; ++steps) {
      if (face == to_.face) return std::max(chord_, sum + (end_ - at).norm());
      const auto [next, point] = leave(face, came_from);
      if (next < 0) return chord_;
      sum += (point - at).norm();
      if (sum > 4 * chord_) return chord_;
      at = point;
      came_from = face;
      face = next;
    }
    return chord_;
  }

 private:
  struct Crossing {
    int face = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
  };

  /// The edge of `face` that the plane cuts, not the one just crossed, nearest to the end.
  [[nodiscard]] Crossing leave(int face, int came_from) const {
    const auto& f = d_.surface->face[face];
    Crossing best;
    double nearest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int g = d_.surface->across[face][k];
      if (g < 0 || g == came_from) continue;
      const Eigen::Vector3d &a = d_.x[f[k]], &b = d_.x[f[(k + 1) % 3]];
      const double sa = side_.dot(a - start_), sb = side_.dot(b - start_);
      if ((sa > 0) == (sb > 0)) continue;
      const Eigen::Vector3d point = a + sa / (sa - sb) * (b - a);
      const double distance = (point - end_).squaredNorm();
      if (best.face >= 0 && distance >= nearest) continue;
      nearest = distance;
      best = {g, point};
    }
    return best;
  }

  const DetailMesh& d_;
  const SurfacePoint from_, to_;
  Eigen::Vector3d start_, end_, side_;
  double chord_ = 0;
};

}  // namespace

void measure_sections(DetailMesh& d) {
  std::vector<double> length(3 * static_cast<std::size_t>(d.mesh.triangle_slots()), 0.0);
  parallel_blocks(length.size(), 1536, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int h = static_cast<int>(i);
      if (d.mesh.origin(h) < 0 || d.mesh.twin(h) > h) continue;
      length[i] = Section(d, d.mesh.origin(h), d.mesh.tip(h)).length();
    }
  });
  for (int i = 0; i < std::ssize(length); ++i)
    if (length[i] > 0) d.mesh.set_length(i, length[i]);
}

}  // namespace geoprior::details
