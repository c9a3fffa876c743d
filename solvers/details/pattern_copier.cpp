#include "solvers/details/pattern_copier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace geoprior::details {
namespace {

/// Centres that stand for all in the histogram of a frame.
constexpr int kHistogramCentres = 512;

/// Triplets tried for a triangle before it is left for the next frame: copies may land in a patch
/// that has enough.
constexpr int kTries = 4;

/// Between two details, so the distance of the nearest two (m).
double shortest_edge(const DetailMesh& d) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int h = 0; h < 3 * d.mesh.triangle_slots(); ++h) {
    if (!d.mesh.triangle_alive(h / 3)) continue;
    if (d.is_detail(d.mesh.origin(h)) && d.is_detail(d.mesh.tip(h)))
      shortest = std::min(shortest, d.mesh.length(h));
  }
  return std::isfinite(shortest) ? shortest : 0;
}

/// Whether a copy landed where the flat triangle does not have it: off the triangle's plane by a
/// quarter of its shortest edge, or with a distance to a corner that is not half to one and a half
/// of that in the triangle (to a quarter of the shortest edge). That is so where a triangle spans
/// surface that it does not follow (bare, or bent within it): copies of many of its places would
/// land on one.
bool strays(const DetailMesh& now, int t, const std::vector<NewDetail>& born) {
  const double e01 = now.mesh.length(3 * t), e12 = now.mesh.length(3 * t + 1),
               e20 = now.mesh.length(3 * t + 2);
  const double least = 0.25 * std::min({e01, e12, e20});
  const auto corner = now.mesh.corners(t);
  return std::any_of(born.begin(), born.end(), [&](const NewDetail& one) {
    const Eigen::Vector3d p = position_of(one.at, *now.surface, now.x);
    Eigen::Vector3d on_plane = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) on_plane += one.barycentric[k] * now.position[corner[k]];
    if ((p - on_plane).norm() > least) return true;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d v = one.barycentric - Eigen::Vector3d::Unit(k);
      const double flat = std::sqrt(std::max(
          0.0, -(e12 * e12 * v[1] * v[2] + e20 * e20 * v[2] * v[0] + e01 * e01 * v[0] * v[1])));
      const double is = (p - now.position[corner[k]]).norm();
      if (is < 0.5 * flat || is > 1.5 * flat + least) return true;
    }
    return false;
  });
}

}  // namespace

PatternCopier::PatternCopier(const DetailMesh& original, const PatternCopierOptions& options,
                             bool leaves_bare, std::uint64_t seed)
    : original_(original),
      options_(options),
      table_(original_, options.triplets, seed),
      correlation_(mean_edge(original_), options.pair_correlation),
      area_per_detail_(total_area(original_) / original_.detail_count()),
      least_gap_(0.5 * shortest_edge(original_)),
      leaves_bare_(leaves_bare) {
  if (options_.histogram) histogram_at_rest_ = correlation_.of(original_);
}

void PatternCopier::begin_frame(const DetailMesh& now) {
  near_.reset();
  if (!options_.histogram) return;
  const int stride = std::max(1, now.detail_count() / kHistogramCentres);
  histogram_now_ = correlation_.of(now, stride);
}

std::optional<std::vector<NewDetail>> PatternCopier::copies_for(const DetailMesh& now, int t,
                                                                int room, const Accept& accept) {
  const std::array<double, 3> edges{now.mesh.length(3 * t), now.mesh.length(3 * t + 1),
                                    now.mesh.length(3 * t + 2)};
  table_.closest(edges, room, options_.histogram ? options_.candidates : kTries, matches_);
  if (matches_.empty()) return std::nullopt;
  std::vector<NewDetail> chosen;
  const TripletMatch* copied = nullptr;
  double best = std::numeric_limits<double>::infinity();
  for (const TripletMatch& match : matches_) {
    std::vector<NewDetail> born = copy_of(match, now, t);
    if (!accept(born) || strays(now, t, born) || crowds(now, born)) continue;
    const double distance = options_.histogram ? histogram_distance(now, t, born) : 0;
    if (distance >= best) continue;
    best = distance;
    chosen = std::move(born);
    copied = &match;
    if (!options_.histogram) break;
  }
  if (copied) carry_tangents(*copied, now, t, chosen);
  return chosen;
}

void PatternCopier::add(const DetailMesh& now, int site) {
  if (!near_) return;
  near_->add(now.position[site], normal_of_face(now.site[site].at.face, *now.surface, now.x));
}

std::vector<NewDetail> PatternCopier::copy_of(const TripletMatch& match, const DetailMesh& now,
                                              int t) const {
  std::vector<NewDetail> born;
  for (const TripletInterior& inside : table_.interior(match.triplet)) {
    const Eigen::Vector3d b = inside.barycentric();
    NewDetail one;
    for (std::size_t k = 0; k < 3; ++k) one.barycentric[k] = b[match.order[k]];
    one.at = surface_point_in(now, t, one.barycentric);
    one.like = original_.site[inside.detail];
    one.like.weight = 0;
    one.like.target_weight = 1;
    born.push_back(one);
  }
  return born;
}

/// Whether a copy is nearer to another detail than half of the nearest two of the original. Asked
/// only where the original leaves surface bare: triangles that span it overlap the pattern, so that
/// what is near in space need not be near in M_d.
bool PatternCopier::crowds(const DetailMesh& now, const std::vector<NewDetail>& born) {
  if (!leaves_bare_ || least_gap_ <= 0) return false;
  if (!near_) {
    near_.emplace(least_gap_, now.site.size());
    near_->add_details(now);
  }
  std::vector<Eigen::Vector3d> places;
  for (const NewDetail& one : born) {
    const Eigen::Vector3d p = position_of(one.at, *now.surface, now.x);
    const auto too_near = [&](const Eigen::Vector3d& other) {
      return (p - other).norm() < least_gap_;
    };
    if (std::any_of(places.begin(), places.end(), too_near)) return true;
    places.push_back(p);
    if (!near_->is_free(p, normal_of_face(one.at.face, *now.surface, now.x), least_gap_))
      return true;
  }
  return false;
}

double PatternCopier::histogram_distance(const DetailMesh& now, int t,
                                         const std::vector<NewDetail>& born) {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(correlation_.bins());
  for (const NewDetail& one : born) {
    correlation_.distances(now, t, one.barycentric, distances_);
    for (const double r : distances_) correlation_.add(r, rows);
  }
  // The mean over centres with k more of them; a pair of a new and an old detail counts at both.
  const double n = now.detail_count(), k = static_cast<double>(born.size());
  const Eigen::VectorXd after = (n * histogram_now_ + 2 * area_per_detail_ * rows) / (n + k);
  return (after - histogram_at_rest_).lpNorm<1>();
}

void PatternCopier::carry_tangents(const TripletMatch& match, const DetailMesh& now, int t,
                                   std::vector<NewDetail>& born) const {
  const auto inside = table_.interior(match.triplet);
  for (std::size_t i = 0; i < born.size(); ++i)
    born[i].like.tangent_angle = carried_angle(match, inside[i].detail, now, t, born[i].at);
}

/// The tangent keeps its angle to that of the first corner that is a detail (mirrored where the
/// triplet is), so that aligned patterns stay aligned; without one, that to the first corner's
/// direction.
double PatternCopier::carried_angle(const TripletMatch& match, int source, const DetailMesh& now,
                                    int t, const SurfacePoint& at) const {
  const Detail& from = original_.site[source];
  const auto corner_now = now.mesh.corners(t);
  const auto corner_then = table_.corners(match.triplet);
  const auto tangent = [](const DetailMesh& d, int site) {
    const Detail& s = d.site[site];
    return tangent_direction(s.at.face, s.tangent_angle, *d.surface, d.x);
  };
  Eigen::Vector3d then =
      original_.position[corner_then[match.order[0]]] - original_.position[source];
  Eigen::Vector3d toward = now.position[corner_now[0]] - position_of(at, *now.surface, now.x);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!now.is_detail(corner_now[k])) continue;
    then = tangent(original_, corner_then[match.order[k]]);
    toward = tangent(now, corner_now[k]);
    break;
  }
  const double was = tangent_angle(from.at.face, then, *original_.surface, original_.x);
  const double is = tangent_angle(at.face, toward, *now.surface, now.x);
  const double offset = from.tangent_angle - was;
  return is + (match.mirrored ? -offset : offset);
}

void describe(OptionVisitor& v, PatternCopierOptions& options) {
  v.value(
      "histogram", options.histogram,
      {.doc =
           "triplets are chosen by the pair correlation that their copies give (the extension)"});
  v.value("candidates", options.candidates,
          {.doc = "m: triplets that the extension compares for a triangle", .min = 1, .max = 64});
  describe_group(v, "triplets", options.triplets,
                 {.doc = "the table T of triplets of the original"});
  describe_group(v, "pair_correlation", options.pair_correlation,
                 {.doc = "the pair correlation that the extension compares"});
}

}  // namespace geoprior::details
