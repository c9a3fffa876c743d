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
  near_.reset();
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
  const TripletMatch* copied = nullptr;
  double best = std::numeric_limits<double>::infinity();
  for (const TripletMatch& match : matches_) {
    std::vector<NewDetail> born = copy_of(match, t);
    if ((budget && !within_budget(born)) || strays(t, born) || crowds(born)) continue;
    const double distance = options_.histogram ? histogram_distance(t, born) : 0;
    if (distance >= best) continue;
    best = distance;
    chosen = std::move(born);
    copied = &match;
    if (!options_.histogram) break;
  }
  if (chosen.empty()) return false;
  carry_tangents(*copied, t, chosen);
  for (const int c : now_.mesh.corners(t)) mark(c);
  const std::vector<int> sites = insert_details(now_, t, chosen);
  find_patches(sites);
  for (const int site : sites) {
    mark(site);
    if (near_)
      near_->add(now_.position[index(site)],
                 normal_of_face(now_.site[index(site)].at.face, *now_.surface, now_.x));
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

/// Whether a copy landed where the flat triangle does not have it: off the triangle's plane by a
/// quarter of its shortest edge, or with a distance to a corner that is not half to one and a half
/// of that in the triangle (to a quarter of the shortest edge). That is so where a triangle spans
/// surface that it does not follow (bare, or bent within it): copies of many of its places would
/// land on one.
bool Replication::strays(int t, const std::vector<NewDetail>& born) const {
  const double e01 = now_.mesh.length(3 * t), e12 = now_.mesh.length(3 * t + 1),
               e20 = now_.mesh.length(3 * t + 2);
  const double least = 0.25 * std::min({e01, e12, e20});
  const auto corner = now_.mesh.corners(t);
  return std::any_of(born.begin(), born.end(), [&](const NewDetail& one) {
    const Eigen::Vector3d p = position_of(one.at, *now_.surface, now_.x);
    Eigen::Vector3d on_plane = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k)
      on_plane += one.barycentric[k] * now_.position[index(corner[static_cast<std::size_t>(k)])];
    if ((p - on_plane).norm() > least) return true;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d v = one.barycentric - Eigen::Vector3d::Unit(k);
      const double flat = std::sqrt(std::max(
          0.0, -(e12 * e12 * v[1] * v[2] + e20 * e20 * v[2] * v[0] + e01 * e01 * v[0] * v[1])));
      const double is = (p - now_.position[index(corner[static_cast<std::size_t>(k)])]).norm();
      if (is < 0.5 * flat || is > 1.5 * flat + least) return true;
    }
    return false;
  });
}

/// Whether a copy is nearer to another detail than half of the nearest two of the original. Asked
/// only where the original leaves surface bare: triangles that span it overlap the pattern, so that
/// what is near in space need not be near in M_d.
bool Replication::crowds(const std::vector<NewDetail>& born) {
  if (!budget_.leaves_bare() || least_gap_ <= 0) return false;
  if (!near_) {
    near_.emplace(least_gap_, now_.site.size());
    near_->add_details(now_);
  }
  std::vector<Eigen::Vector3d> places;
  for (const NewDetail& one : born) {
    const Eigen::Vector3d p = position_of(one.at, *now_.surface, now_.x);
    const auto too_near = [&](const Eigen::Vector3d& other) {
      return (p - other).norm() < least_gap_;
    };
    if (std::any_of(places.begin(), places.end(), too_near)) return true;
    places.push_back(p);
    if (!near_->is_free(p, normal_of_face(one.at.face, *now_.surface, now_.x), least_gap_))
      return true;
  }
  return false;
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
    born.push_back(one);
  }
  return born;
}

void Replication::carry_tangents(const TripletMatch& match, int t,
                                 std::vector<NewDetail>& born) const {
  const auto inside = table_.interior(match.triplet);
  for (std::size_t i = 0; i < born.size(); ++i)
    born[i].like.tangent_angle = carried_angle(match, inside[i].detail, t, born[i].at);
}

/// The tangent keeps its angle to that of the first corner that is a detail (mirrored where the
/// triplet is), so that aligned patterns stay aligned; without one, that to the first corner's
/// direction.
double Replication::carried_angle(const TripletMatch& match, int source, int t,
                                  const SurfacePoint& at) const {
  const Detail& from = original_.site[index(source)];
  const auto corner_now = now_.mesh.corners(t);
  const auto corner_then = table_.corners(match.triplet);
  const auto tangent = [](const DetailMesh& d, int site) {
    const Detail& s = d.site[index(site)];
    return tangent_direction(s.at.face, s.tangent_angle, *d.surface, d.x);
  };
  Eigen::Vector3d then = original_.position[index(corner_then[index(match.order[0])])] -
                         original_.position[index(source)];
  Eigen::Vector3d now =
      now_.position[index(corner_now[0])] - position_of(at, *now_.surface, now_.x);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!now_.is_detail(corner_now[k])) continue;
    then = tangent(original_, corner_then[index(match.order[k])]);
    now = tangent(now_, corner_now[k]);
    break;
  }
  const double was = tangent_angle(from.at.face, then, *original_.surface, original_.x);
  const double is = tangent_angle(at.face, now, *now_.surface, now_.x);
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
