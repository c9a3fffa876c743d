#include "models/details/area_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include "core/parallel.h"

namespace geoprior::details {
namespace {

/// Details no two of which are joined by `hops` edges of M_d or fewer, in order of their numbers.
std::vector<int> seeds_of(const DetailMesh& d, int hops) {
  std::vector<int> seeds, ring, next, around;
  std::vector<char> near_seed(d.site.size(), 0);
  std::vector<int> stamp(d.site.size(), -1);
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i) || near_seed[i] != 0) continue;
    ring = {i};
    stamp[i] = i;
    near_seed[i] = 1;
    for (int hop = 0; hop < hops; ++hop) {
      next.clear();
      for (const int v : ring) {
        d.mesh.neighbours(v, around);
        for (const int w : around) {
          if (stamp[w] == i) continue;
          stamp[w] = i;
          near_seed[w] = 1;
          next.push_back(w);
        }
      }
      ring.swap(next);
    }
    seeds.push_back(i);
  }
  return seeds;
}

/// Distances along the faces (between their centres) from the faces of some details, and the
/// detail that is nearest.
struct FaceDistances {
  std::vector<double> distance;
  std::vector<int> nearest;  ///< position in the list of sources; -1: not reached
};

FaceDistances face_distances(const DetailMesh& d, const std::vector<int>& sources, double reach) {
  const SurfaceTopology& s = *d.surface;
  const auto centre = [&](int f) -> Eigen::Vector3d {
    const auto& v = s.face[f];
    return (d.x[v[0]] + d.x[v[1]] + d.x[v[2]]) / 3;
  };
  FaceDistances result{std::vector<double>(s.face.size(), std::numeric_limits<double>::infinity()),
                       std::vector<int>(s.face.size(), -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](int face, double distance, int source) {
    if (!(distance < result.distance[face])) return;
    result.distance[face] = distance;
    result.nearest[face] = source;
    queue.emplace(distance, face);
  };
  for (int i = 0; i < std::ssize(sources); ++i) {
    const int f = d.site[sources[i]].at.face;
    offer(f, (centre(f) - d.position[sources[i]]).norm(), i);
  }
  while (!queue.empty()) {
    const auto [distance, f] = queue.top();
    queue.pop();
    if (distance > result.distance[f] || distance > reach) continue;
    for (const int g : s.across[f])
      if (g >= 0) offer(g, distance + (centre(g) - centre(f)).norm(), result.nearest[f]);
  }
  return result;
}

/// Mean of the three shortest edges of a detail to others: its spacing, also at the rim of a
/// pattern, whose other edges span bare surface.
double near_spacing(const DetailMesh& d, int site) {
  std::array<double, 3> shortest;
  shortest.fill(std::numeric_limits<double>::infinity());
  const int start = d.mesh.outgoing(site);
  for (int h = start; h >= 0;) {
    if (d.is_detail(d.mesh.tip(h)) && d.mesh.length(h) < shortest[2]) {
      shortest[2] = d.mesh.length(h);
      std::sort(shortest.begin(), shortest.end());
    }
    h = d.mesh.twin(IntrinsicTriangulation::previous(h));
    if (h == start) break;
  }
  double sum = 0;
  int known = 0;
  for (const double length : shortest) {
    if (!std::isfinite(length)) continue;
    sum += length;
    ++known;
  }
  return known > 0 ? sum / known : 0;
}

}  // namespace

AreaBudget::AreaBudget(const DetailMesh& original, int details_per_patch) {
  // Seeds h + 1 edges apart have cells of about (h + 1)^2 details.
  const int hops = std::max(0, static_cast<int>(std::lround(std::sqrt(details_per_patch))) - 1);
  patch_ =
      face_distances(original, seeds_of(original, hops), std::numeric_limits<double>::infinity())
          .nearest;
  leave_bare_faces(original);
  double bare = 0, all = 0;
  for (std::size_t f = 0; f < patch_.size(); ++f) {
    all += original.surface->rest_area[f];
    if (patch_[f] < 0) bare += original.surface->rest_area[f];
  }
  leaves_bare_ = bare > kBareShare * all;
  int patches = 0;
  for (const int p : patch_) patches = std::max(patches, p + 1);
  face_begin_.assign(static_cast<std::size_t>(patches) + 1, 0);
  for (const int p : patch_)
    if (p >= 0) ++face_begin_[p + 1];
  std::partial_sum(face_begin_.begin(), face_begin_.end(), face_begin_.begin());
  face_.resize(face_begin_.back());
  std::vector<int> fill(face_begin_.begin(), face_begin_.end() - 1);
  for (int f = 0; f < std::ssize(patch_); ++f)
    if (patch_[f] >= 0) face_[fill[patch_[f]]++] = f;
  rest_area_.assign(patches, 0);
  rest_count_.assign(patches, 0);
  for (std::size_t f = 0; f < patch_.size(); ++f)
    if (patch_[f] >= 0) rest_area_[patch_[f]] += original.surface->rest_area[f];
  for (int i = 0; i < original.site_slots(); ++i)
    if (original.is_detail(i)) ++rest_count_[patch_of(original.site[i].at)];
  count(original);
  update(original);
}

void AreaBudget::leave_bare_faces(const DetailMesh& original) {
  std::vector<int> all;
  for (int i = 0; i < original.site_slots(); ++i)
    if (original.is_detail(i)) all.push_back(i);
  const double mean = mean_edge(original);
  std::vector<double> reach;
  for (const int i : all) reach.push_back(kBareAfter * std::max(mean, near_spacing(original, i)));
  const double largest = all.empty() ? 0 : *std::max_element(reach.begin(), reach.end());
  const FaceDistances from_details = face_distances(original, all, largest);
  const std::vector<int> nearest_seed = patch_;
  for (std::size_t f = 0; f < patch_.size(); ++f) {
    const int nearest = from_details.nearest[f];
    if (nearest < 0 || from_details.distance[f] > reach[nearest]) patch_[f] = -1;
  }
  for (const int i : all) {
    // A face larger than the reach still holds its details.
    const std::size_t f = original.site[i].at.face;
    patch_[f] = nearest_seed[f];
  }
}

void AreaBudget::update(const DetailMesh& details, const Lead& lead) {
  target_.resize(rest_area_.size());
  if (area_.empty()) area_ = rest_area_;
  parallel_blocks(rest_area_.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      double area = 0;
      for (int i = face_begin_[p]; i < face_begin_[p + 1]; ++i)
        area += area_of_face(face_[i], *details.surface, details.x);
      const double change = area - area_[p];
      const double ahead =
          std::max(0.0, area + (change > 0 ? lead.growing : lead.shrinking) * change);
      target_[p] = rest_area_[p] > 0 ? rest_count_[p] * ahead / rest_area_[p] : 0;
      area_[p] = area;
    }
  });
}

void AreaBudget::count(const DetailMesh& details) {
  count_.assign(rest_area_.size(), 0);
  for (int i = 0; i < details.site_slots(); ++i) {
    const Detail& d = details.site[i];
    if (details.is_detail(i) && d.target_weight > 0) add(patch_of(d.at), 1);
  }
}

double AreaBudget::deficit(int patch) const {
  if (patch < 0) return 0;
  return target_[patch] - count_[patch];
}

void AreaBudget::add(int patch, int change) {
  if (patch >= 0) count_[patch] += change;
}

double AreaBudget::total_target() const {
  return std::accumulate(target_.begin(), target_.end(), 0.0);
}

}  // namespace geoprior::details
