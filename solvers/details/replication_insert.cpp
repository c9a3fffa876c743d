#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/details/replication_state.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Triplets tried for a triangle before it is left for the next frame: copies may land in a patch
/// that has enough.
constexpr int kTries = 4;

}  // namespace

void Replication::revive() {
  std::vector<std::pair<double, int>> fading;
  for (int i = 0; i < now_.site_slots(); ++i) {
    if (need_[index(i)] != Need::more || !now_.is_detail(i)) continue;
    const Detail& d = now_.site[index(i)];
    if (d.target_weight == 0) fading.emplace_back(-d.weight, i);
  }
  std::sort(fading.begin(), fading.end());
  for (const auto& [weight, i] : fading) {
    const int patch = patch_of_site(i);
    if (budget_.deficit(patch) < limit()) continue;
    now_.site[index(i)].target_weight = 1;
    budget_.add(patch, 1);
    ++counts_.revived;
  }
}

double Replication::largest_deficit(int t) const {
  double largest = 0;
  for (const int c : now_.mesh.corners(t))
    largest = std::max(largest, budget_.deficit(patch_of_site(c)));
  return largest;
}

void Replication::insert() {
  const double threshold = options_.area_rule == AreaRule::budget ? 0 : options_.stretch_threshold;
  rank_triangles(Need::more, [&](int t) {
    const double r = ratio(t);
    return r > threshold ? -r : kNotWanting;
  });
  if (wanting_.empty()) return;
  if (options_.histogram) measure_histogram();
  use_new_marks();
  act_in_order(Need::more, [&](int t) {
    if (options_.max_insertions && counts_.inserted >= *options_.max_insertions) return;
    // A triangle that an insertion of this frame rewrote has a corner that is marked.
    if (now_.mesh.triangle_alive(t) && !marked(t)) fill(t);
  });
}

bool Replication::fill(int t) {
  const bool budget = options_.area_rule == AreaRule::budget;
  int room = options_.triplets.interior_capacity;
  if (budget) {
    const double deficit = largest_deficit(t);
    if (deficit < limit()) return false;  // met by an insertion of this frame
    room = std::min(room, std::max(1, static_cast<int>(deficit + 0.5)));
  }
  const std::array<double, 3> edges{now_.mesh.length(3 * t), now_.mesh.length(3 * t + 1),
                                    now_.mesh.length(3 * t + 2)};
  table_.closest(edges, room, options_.histogram ? options_.candidates : kTries, matches_);
  if (matches_.empty()) {
    ++counts_.failed_queries;
    return false;
  }
  std::vector<NewDetail> chosen;
  double best = std::numeric_limits<double>::infinity();
  for (const TripletMatch& match : matches_) {
    std::vector<NewDetail> born = copy_of(match, t);
    if (budget && !within_budget(born)) continue;
    const double distance = options_.histogram ? histogram_distance(t, born) : 0;
    if (distance >= best) continue;
    best = distance;
    chosen = std::move(born);
    if (!options_.histogram) break;
  }
  if (chosen.empty()) return false;
  for (const int c : now_.mesh.corners(t)) mark(c);
  const std::vector<int> sites = insert_details(now_, t, chosen);
  find_patches(sites);
  for (const int site : sites) {
    mark(site);
    budget_.add(patch_of_site(site), 1);
    ++counts_.inserted;
  }
  return true;
}

bool Replication::within_budget(const std::vector<NewDetail>& born) const {
  for (std::size_t i = 0; i < born.size(); ++i) {
    const int patch = budget_.patch_of(born[i].at);
    const auto before =
        std::count_if(born.begin(), born.begin() + static_cast<std::ptrdiff_t>(i),
                      [&](const NewDetail& other) { return budget_.patch_of(other.at) == patch; });
    if (budget_.deficit(patch) - static_cast<double>(before) < limit()) return false;
  }
  return true;
}

std::vector<NewDetail> Replication::copy_of(const TripletMatch& match, int t) const {
  std::vector<NewDetail> born;
  for (const TripletInterior& inside : table_.interior(match.triplet)) {
    const Eigen::Vector3d b = inside.barycentric();
    NewDetail one;
    for (std::size_t k = 0; k < 3; ++k)
      one.barycentric[static_cast<Eigen::Index>(k)] = b[match.order[k]];
    one.at = surface_point_in(now_, t, one.barycentric);
    one.like = original_.site[index(inside.detail)];
    one.like.weight = 0;
    one.like.target_weight = 1;
    one.like.tangent_angle = carried_angle(match, inside.detail, t, one.at);
    born.push_back(one);
  }
  return born;
}

/// The tangent keeps its angle to the direction of the first corner (mirrored where the triplet
/// is).
double Replication::carried_angle(const TripletMatch& match, int source, int t,
                                  const SurfacePoint& at) const {
  const Detail& from = original_.site[index(source)];
  const int from_corner = table_.corners(match.triplet)[index(match.order[0])];
  const double was = tangent_angle(
      from.at.face, original_.position[index(from_corner)] - original_.position[index(source)],
      *original_.surface, original_.x);
  const Eigen::Vector3d towards =
      now_.position[index(now_.mesh.origin(3 * t))] - position_of(at, *now_.surface, now_.x);
  const double is = tangent_angle(at.face, towards, *now_.surface, now_.x);
  const double offset = from.tangent_angle - was;
  return is + (match.mirrored ? -offset : offset);
}

double Replication::histogram_distance(int t, const std::vector<NewDetail>& born) {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(correlation_.bins());
  for (const NewDetail& one : born) {
    correlation_.distances(now_, t, one.barycentric, distances_);
    for (const double r : distances_) correlation_.add(r, rows);
  }
  // The mean over centres with k more of them; a pair of a new and an old detail counts at both.
  const double n = now_.detail_count(), k = static_cast<double>(born.size());
  const Eigen::VectorXd after = (n * histogram_now_ + 2 * area_per_detail_ * rows) / (n + k);
  return (after - histogram_at_rest_).lpNorm<1>();
}

}  // namespace geoprior
