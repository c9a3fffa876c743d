#include "baselines/details/shared/density_moves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "core/geometry/planar.h"
#include "core/parallel.h"

namespace geoprior::details {
namespace {

/// A new vertex keeps this much away from the rim of its triangle (barycentric).
constexpr double kInside = 1e-3;
/// Triangles crossed on the way to a circumcentre: a bound against round-off.
constexpr int kMostCrossed = 64;

/// Apex of the triangle left of the segment from `a` to `b`, from its distances to both.
Eigen::Vector2d apex(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double to_a, double to_b) {
  const Eigen::Vector2d along = b - a;
  const double base = along.norm();
  const double x = (base * base + (to_a - to_b) * (to_a + to_b)) / (2 * base);
  const double y = std::sqrt(std::max(0.0, (to_a - x) * (to_a + x)));
  return a + (x * along + y * Eigen::Vector2d(-along.y(), along.x())) / base;
}

/// A triangle laid out in the plane: corners from the origin of half-edge `base` on.
struct Unfolded {
  int base = 0;
  std::array<Eigen::Vector2d, 3> corner;

  /// Over edge k (from corner k to k + 1).
  [[nodiscard]] std::optional<Unfolded> across(const IntrinsicTriangulation& mesh,
                                               std::size_t k) const {
    int h = base;
    for (std::size_t i = 0; i < k; ++i) h = IntrinsicTriangulation::next(h);
    const int g = mesh.twin(h);
    if (g < 0) return {};
    const Eigen::Vector2d &a = corner[(k + 1) % 3], &b = corner[k];
    return Unfolded{g,
                    {a, b,
                     apex(a, b, mesh.length(IntrinsicTriangulation::previous(g)),
                          mesh.length(IntrinsicTriangulation::next(g)))}};
  }

  [[nodiscard]] Eigen::Vector3d barycentric(const Eigen::Vector2d& p) const {
    Eigen::Vector3d b;
    for (std::size_t k = 0; k < 3; ++k)
      b[k] = cross(corner[(k + 2) % 3] - corner[(k + 1) % 3], p - corner[(k + 1) % 3]);
    return b / b.sum();
  }
};

Eigen::Vector2d circumcentre_of(const std::array<Eigen::Vector2d, 3>& p) {
  const Eigen::Vector2d u = p[1] - p[0], v = p[2] - p[0];
  const Eigen::Vector2d w = u.squaredNorm() * v - v.squaredNorm() * u;
  return p[0] + Eigen::Vector2d(w.y(), -w.x()) / (2 * cross(u, v));
}

}  // namespace

std::vector<double> spacing_of_sites(const DetailMesh& d, const RestDensity& density) {
  std::vector<double> spacing(d.site.size());
  for (std::size_t i = 0; i < spacing.size(); ++i) spacing[i] = density.spacing(d.site[i].at.face);
  return spacing;
}

double spacing_of(const DetailMesh& d, int t, const std::vector<double>& spacing) {
  double sum = 0;
  int known = 0;
  for (const int c : d.mesh.corners(t)) {
    if (!std::isfinite(spacing[c])) continue;
    sum += spacing[c];
    ++known;
  }
  return known > 0 ? sum / known : std::numeric_limits<double>::infinity();
}

std::optional<MeshPoint> circumcentre(const IntrinsicTriangulation& mesh, int t) {
  const Eigen::Vector2d origin = Eigen::Vector2d::Zero(), end(mesh.length(3 * t), 0);
  Unfolded here{3 * t,
                {origin, end, apex(origin, end, mesh.length(3 * t + 2), mesh.length(3 * t + 1))}};
  const Eigen::Vector2d centre = circumcentre_of(here.corner);
  for (int crossed = 0; crossed < kMostCrossed; ++crossed) {
    const Eigen::Vector3d b = here.barycentric(centre);
    if (!b.allFinite()) return {};
    Eigen::Index least = 0;
    if (b.minCoeff(&least) >= 0) {
      MeshPoint found{here.base / 3, Eigen::Vector3d::Zero()};
      for (Eigen::Index k = 0; k < 3; ++k) found.barycentric[(here.base + k) % 3] = b[k];
      return found;
    }
    const auto next = here.across(mesh, (static_cast<std::size_t>(least) + 1) % 3);
    if (!next) return {};
    here = *next;
  }
  return {};
}

DensityMoves::DensityMoves(DetailMesh& details, const RestDensity& density, AreaBudget& budget,
                           double dead_band)
    : now_(details), density_(density), budget_(budget), limit_(0.5 + dead_band) {}

void DensityMoves::measure(const AreaBudget::Lead& lead) {
  budget_.count(now_);
  budget_.update(now_, lead);
  spacing_ = spacing_of_sites(now_, density_);
  touched_.assign(now_.site.size(), 0);
}

double DensityMoves::deficit(int site) const {
  return budget_.deficit(budget_.patch_of(now_.site[site].at));
}

bool DensityMoves::lacks(int t) const {
  const auto corner = now_.mesh.corners(t);
  return std::any_of(corner.begin(), corner.end(), [&](int c) { return deficit(c) >= limit_; });
}

void DensityMoves::touch(int t) {
  for (const int c : now_.mesh.corners(t)) touched_[c] = 1;
}

/// A triangle that an insertion rewrote has the new vertex, which counts as touched.
bool DensityMoves::touched(int t) const {
  const auto corner = now_.mesh.corners(t);
  return std::any_of(corner.begin(), corner.end(), [&](int c) {
    return static_cast<std::size_t>(c) >= touched_.size() || touched_[c] != 0;
  });
}

bool DensityMoves::may_fade(int site) const {
  return now_.is_detail(site) && now_.site[site].target_weight > 0 && deficit(site) <= -limit_;
}

/// Shortest edge of a site to another detail than `but`.
double DensityMoves::second_edge(int site, int but) const {
  double shortest = std::numeric_limits<double>::infinity();
  const int start = now_.mesh.outgoing(site);
  for (int h = start; h >= 0;) {
    const int tip = now_.mesh.tip(h);
    if (tip != but && now_.is_detail(tip)) shortest = std::min(shortest, now_.mesh.length(h));
    h = now_.mesh.twin(IntrinsicTriangulation::previous(h));
    if (h == start) break;
  }
  return shortest;
}

int DensityMoves::fade_shortest_edges(double most) {
  std::vector<std::pair<double, int>> order;
  for (int h = 0; h < 3 * now_.mesh.triangle_slots(); ++h) {
    const int a = now_.mesh.origin(h);
    if (a < 0 || now_.mesh.twin(h) > h) continue;
    const int b = now_.mesh.tip(h);
    if (!may_fade(a) || !may_fade(b)) continue;
    const double length = 2 * now_.mesh.length(h) / (kLatticeEdge * (spacing_[a] + spacing_[b]));
    if (length < most) order.emplace_back(length, h);
  }
  std::sort(order.begin(), order.end());
  std::vector<char> ended(now_.site.size(), 0);
  int faded = 0;
  for (const auto& [length, h] : order) {
    const int a = now_.mesh.origin(h), b = now_.mesh.tip(h);
    if (ended[a] != 0 || ended[b] != 0 || !may_fade(a) || !may_fade(b)) continue;
    const auto crowding = [&](int site, int other) {
      return std::tuple(second_edge(site, other), -now_.site[site].birth);
    };
    const int gone = crowding(a, b) < crowding(b, a) ? a : b;
    ended[a] = ended[b] = 1;
    fade_detail(now_, gone, budget_);
    ++faded;
  }
  return faded;
}

bool DensityMoves::insert_near(int t, double least) {
  const auto place = circumcentre(now_.mesh, t);
  if (!place || touched(place->triangle)) return false;
  Eigen::Vector3d b = place->barycentric.cwiseMax(kInside);
  b /= b.sum();
  const SurfacePoint at = surface_point_in(now_, place->triangle, b);
  const int patch = budget_.patch_of(at);
  if (budget_.deficit(patch) < limit_ ||
      !(circumradius(now_.mesh, t) > least * kLatticeRadius * density_.spacing(at.face)))
    return false;
  touch(t);
  touch(place->triangle);
  const NewDetail born{b, at, newborn_like_neighbour(now_, place->triangle, b, at)};
  const int site = insert_details(now_, place->triangle, {&born, 1})[0];
  if (static_cast<std::size_t>(site) < touched_.size()) touched_[site] = 1;
  budget_.add(patch, 1);
  return true;
}

int DensityMoves::insert_at_circumcentres(double least) {
  std::vector<double> rank(now_.mesh.triangle_slots(), 0);
  parallel_blocks(rank.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int t = static_cast<int>(i);
      if (now_.mesh.triangle_alive(t) && lacks(t))
        rank[i] = circumradius(now_.mesh, t) / (kLatticeRadius * spacing_of(now_, t, spacing_));
    }
  });
  std::vector<std::pair<double, int>> order;
  for (int t = 0; t < std::ssize(rank); ++t)
    if (rank[t] > least) order.emplace_back(-rank[t], t);
  std::sort(order.begin(), order.end());
  int inserted = 0;
  for (const auto& [minus_rank, t] : order)
    if (!touched(t) && lacks(t) && insert_near(t, least)) ++inserted;
  return inserted;
}

DensityChanges DensityMoves::keep_number(const DensityMoveOptions& options, RunContext& context) {
  DensityChanges changes;
  {
    const Phase phase(context, "budget");
    measure(lead_of(options.anticipate, options.weight_rate));
    changes.revived = revive_details(now_, budget_, limit_);
  }
  {
    const Phase phase(context, "merge");
    changes.fading = fade_shortest_edges(options.shortest_edge);
  }
  const Phase phase(context, "insert");
  changes.inserted = insert_at_circumcentres(options.circumradius);
  return changes;
}

void DensityChanges::diagnose(std::map<std::string, double>& into) const {
  into["inserted"] = inserted;
  into["revived"] = revived;
  into["fading"] = fading;
}

DensityMethod::DensityMethod(const DetailScene& scene, const DensityMoveOptions& options)
    : now_(build_detail_mesh(scene.surface, scene.details)),
      density_(now_),
      options_(options),
      budget_(now_, options.patch_details),
      moves_(now_, density_, budget_, options.dead_band) {}

void DensityMethod::step(const Eigen::MatrixX3d& V, RunContext& context) {
  const bool moved = surface_differs(now_, V);
  int flips = 0;
  report_ = step_details(now_, V, options_.lengths, options_.weight_rate, context, [&] {
    changes_ = moves_.keep_number(options_, context);
    flips = relax(moved, context);
  });
  report_.flips += flips;
}

void DensityMethod::diagnose(std::map<std::string, double>& into) const {
  changes_.diagnose(into);
  into["flips"] = report_.flips;
  into["refused_flips"] = static_cast<double>(now_.mesh.refused_flips());
  into["max_weight_change"] = report_.max_weight_change;
}

void DensityMethod::save(StateWriter& out) const {
  now_.save(out);
  budget_.save(out);
}

void DensityMethod::load(StateReader& in) {
  now_.load(in);
  budget_.load(in);
}

void describe(OptionVisitor& v, DensityMoveOptions& options) {
  v.value("circumradius", options.circumradius,
          {.doc = "smallest circumradius that is filled, over that of the lattice of the density",
           .min = 0});
  v.value("shortest_edge", options.shortest_edge,
          {.doc = "an edge may lose an end below this length, over that of the lattice of the "
                  "density",
           .min = 0});
  v.value("patch_details", options.patch_details, {.doc = "details of a patch at rest", .min = 1});
  v.value("dead_band", options.dead_band,
          {.doc = "a patch acts when its details are off by more than 1/2 + this",
           .min = 0,
           .max = 10});
  v.value("anticipate", options.anticipate,
          {.doc = "growing patches ask K / 4 frames ahead, shrinking ones 3 K / 4, with "
                  "K = 1 / weight_rate"});
  v.value("weight_rate", options.weight_rate,
          {.doc = "largest change of a weight in a frame", .min = 1e-3, .max = 1});
  describe_lengths(v, options.lengths);
}

}  // namespace geoprior::details
