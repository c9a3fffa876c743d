#include "baselines/details/shared/rest_density.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

namespace geoprior::details {
namespace {

/// Averages over neighbours: with the star itself, triangles within three edges.
constexpr int kRounds = 2;

/// Per site: details and area of its star, summed over its surroundings.
struct Surroundings {
  double details = 0;
  double area = 0;
};

std::vector<Surroundings> stars(const DetailMesh& d) {
  std::vector<Surroundings> star(d.site.size());
  for (int t = 0; t < d.mesh.triangle_slots(); ++t) {
    if (!d.mesh.triangle_alive(t)) continue;
    const auto corner = d.mesh.corners(t);
    if (std::any_of(corner.begin(), corner.end(), [&](int c) { return !d.is_detail(c); })) continue;
    const double area = d.mesh.area(t);
    for (const int c : corner) {
      star[c].details += 0.5;
      star[c].area += area;
    }
  }
  return star;
}

std::vector<double> density_of_sites(const DetailMesh& d) {
  std::vector<Surroundings> here = stars(d);
  std::vector<int> neighbours;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Surroundings> sum = here;
    for (int i = 0; i < d.site_slots(); ++i) {
      if (d.kind[i] == SiteKind::empty) continue;
      d.mesh.neighbours(i, neighbours);
      for (const int j : neighbours) {
        sum[i].details += here[j].details;
        sum[i].area += here[j].area;
      }
    }
    here = std::move(sum);
  }
  Surroundings all;
  for (const Surroundings& s : here) {
    all.details += s.details;
    all.area += s.area;
  }
  // Few details on an open surface: no triangle is free of ghosts, and `normalise` finds the scale.
  const double mean = all.area > 0 ? all.details / all.area : 1;
  std::vector<double> density(here.size(), mean);
  for (std::size_t i = 0; i < here.size(); ++i)
    if (here[i].area > 0) density[i] = here[i].details / here[i].area;
  return density;
}

Eigen::Vector3d centre_of(int face, const DetailMesh& d) {
  return position_of({face, Eigen::Vector3d::Constant(1.0 / 3)}, *d.surface, d.x);
}

}  // namespace

RestDensity::RestDensity(const DetailMesh& original)
    : density_(original.surface->face.size(), 0.0) {
  spread(original, density_of_sites(original));
  normalise(original);
}

/// Multi-source Dijkstra from face to face: every face takes the density of the detail that reaches
/// it first.
void RestDensity::spread(const DetailMesh& d, const std::vector<double>& of_site) {
  using Reached = std::tuple<double, int, int>;  // distance, face, site
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i)) continue;
    const int face = d.site[i].at.face;
    queue.emplace((centre_of(face, d) - d.position[i]).norm(), face, i);
  }
  const double mean = mean_edge(d);
  const double reach = mean > 0 ? kBareAfter * mean : std::numeric_limits<double>::infinity();
  std::vector<char> done(density_.size(), 0);
  while (!queue.empty()) {
    const auto [distance, face, site] = queue.top();
    queue.pop();
    if (done[face] != 0) continue;
    done[face] = 1;
    density_[face] = of_site[site];
    const Eigen::Vector3d centre = centre_of(face, d);
    for (const int next : d.surface->across[face]) {
      if (next < 0 || done[next] != 0) continue;
      const double there = distance + (centre_of(next, d) - centre).norm();
      if (there <= reach) queue.emplace(there, next, site);
    }
  }
}

void RestDensity::normalise(const DetailMesh& d) {
  const double count = d.detail_count(), sum = expected(d);
  double area = 0;
  for (std::size_t f = 0; f < density_.size(); ++f) {
    density_[f] *= count / sum;
    if (density_[f] > 0) area += d.surface->rest_area[f];
  }
  mean_spacing_ = std::sqrt(area / count);
}

double RestDensity::spacing(int face) const {
  const double density = at(face);
  return density > 0 ? 1 / std::sqrt(density) : std::numeric_limits<double>::infinity();
}

double RestDensity::stretch(int face, const DetailMesh& now) {
  return area_of_face(face, *now.surface, now.x) / now.surface->rest_area[face];
}

double RestDensity::expected(const DetailMesh& now) const {
  double sum = 0;
  for (int f = 0; f < now.surface->face_count(); ++f)
    if (at(f) > 0) sum += at(f) * area_of_face(f, *now.surface, now.x);
  return sum;
}

Detail newborn_like_neighbour(const DetailMesh& d, int t, const Eigen::Vector3d& barycentric,
                              const SurfacePoint& at) {
  Detail born;
  double nearest = -1;
  const auto corner = d.mesh.corners(t);
  for (std::size_t k = 0; k < 3; ++k) {
    const double b = barycentric[k];
    if (!d.is_detail(corner[k]) || b <= nearest) continue;
    nearest = b;
    const Detail& like = d.site[corner[k]];
    born.type = like.type;
    const Eigen::Vector3d tangent =
        tangent_direction(like.at.face, like.tangent_angle, *d.surface, d.x);
    born.tangent_angle = tangent_angle(at.face, tangent, *d.surface, d.x);
  }
  born.at = at;
  born.weight = 0;
  born.target_weight = 1;
  return born;
}

double circumradius(const IntrinsicTriangulation& mesh, int t) {
  const double area = mesh.area(t);
  if (!(area > 0)) return std::numeric_limits<double>::infinity();
  return mesh.length(3 * t) * mesh.length(3 * t + 1) * mesh.length(3 * t + 2) / (4 * area);
}

}  // namespace geoprior::details
