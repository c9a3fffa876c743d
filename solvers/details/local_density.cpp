#include "solvers/details/local_density.h"

#include <algorithm>
#include <vector>

namespace geoprior::details {
namespace {

bool has_ghost(const DetailMesh& d, int t) {
  const auto corner = d.mesh.corners(t);
  return std::any_of(corner.begin(), corner.end(), [&](int c) { return !d.is_detail(c); });
}

/// Area per detail (two triangles) around every site; 0 where it is not known.
std::vector<double> star_areas(const DetailMesh& d) {
  std::vector<double> area(d.site.size(), 0), count(d.site.size(), 0);
  for (int t = 0; t < d.mesh.triangle_slots(); ++t) {
    if (!d.mesh.triangle_alive(t) || has_ghost(d, t)) continue;
    for (const int c : d.mesh.corners(t)) {
      area[c] += d.mesh.area(t);
      count[c] += 0.5;
    }
  }
  for (std::size_t i = 0; i < area.size(); ++i)
    if (count[i] > 0) area[i] /= count[i];
  return area;
}

/// Mean of what is known at a site and its neighbours.
std::vector<double> averaged(const DetailMesh& d, const std::vector<double>& value) {
  std::vector<double> result(value.size(), 0);
  std::vector<int> ring;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (d.kind[i] == SiteKind::empty) continue;
    d.mesh.neighbours(i, ring);
    ring.push_back(i);
    double sum = 0;
    int known = 0;
    for (const int j : ring) {
      if (!(value[j] > 0)) continue;
      sum += value[j];
      ++known;
    }
    if (known > 0) result[i] = sum / known;
  }
  return result;
}

}  // namespace

void smooth_densities(DetailMesh& d, int rounds) {
  std::vector<double> area = star_areas(d);
  for (int round = 0; round < rounds; ++round) area = averaged(d, area);
  for (int t = 0; t < d.mesh.triangle_slots(); ++t) {
    if (!d.mesh.triangle_alive(t)) continue;
    double sum = 0;
    int known = 0;
    for (const int c : d.mesh.corners(t)) {
      if (!(area[c] > 0)) continue;
      sum += area[c];
      ++known;
    }
    if (known > 0) d.mesh.set_density(t, known / sum);
  }
}

}  // namespace geoprior::details
