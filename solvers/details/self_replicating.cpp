#include "solvers/details/self_replicating.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/state_bytes.h"
#include "models/details/area_budget.h"
#include "models/details/detail_step.h"
#include "models/details/point_grid.h"
#include "solvers/details/local_density.h"
#include "solvers/details/pair_correlation.h"
#include "solvers/details/triplet_table.h"

namespace geoprior::details {
namespace {

/// What a step changed.
struct StepCounts {
  int inserted = 0;
  int revived = 0;
  int fading = 0;
  int failed_queries = 0;
};

/// A triangle of M_d that asks for a change, for the sake of a patch. The least rank comes first;
/// ties by number.
struct WantingTriangle {
  double rank = 0;
  int triangle = 0;
  int patch = 0;
};

/// What the patch of a site asks for.
enum class Need : signed char { fewer = -1, nothing = 0, more = 1 };

/// The method: `step` in the order of the header of `SelfReplicatingOptions`.
class SelfReplicating final : public DetailMethod {
 public:
  SelfReplicating(const DetailScene& scene, const SelfReplicatingOptions& options,
                  std::uint64_t seed);
  void step(const Eigen::MatrixX3d& V, RunContext& context) override;
  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override;
  void save(StateWriter& out) const override;
  void load(StateReader& in) override;

 private:
  // The area that a triangle wants (m^2), and its area over that: more details belong where it is
  // large.
  [[nodiscard]] double wanted_area(int triangle) const;
  [[nodiscard]] double ratio(int triangle) const;
  [[nodiscard]] int patch_of_site(int site) const { return patch_of_site_[site]; }
  void find_patches(std::span<const int> sites);
  void find_all_patches();
  /// A patch acts when it is off by this many details.
  [[nodiscard]] double limit() const { return 0.5 + options_.dead_band; }
  void find_needs();
  [[nodiscard]] int patch_in_need(int triangle, Need need) const;
  void rank_triangles(Need need, const std::function<double(int)>& rank);
  void act_in_order(Need need, const std::function<void(int)>& act);
  void use_new_marks();
  [[nodiscard]] bool marked(int triangle) const;
  void mark(int site);
  [[nodiscard]] double weight_step(const Eigen::MatrixX3d& V) const;

  // Filling stretched triangles.
  void insert();
  [[nodiscard]] double largest_deficit(int triangle) const;
  bool fill(int triangle);
  [[nodiscard]] std::vector<NewDetail> copy_of(const TripletMatch& match, int triangle) const;
  [[nodiscard]] bool strays(int triangle, const std::vector<NewDetail>& born) const;
  [[nodiscard]] bool crowds(const std::vector<NewDetail>& born);
  void carry_tangents(const TripletMatch& match, int triangle, std::vector<NewDetail>& born) const;
  [[nodiscard]] double carried_angle(const TripletMatch& match, int source, int triangle,
                                     const SurfacePoint& at) const;
  [[nodiscard]] bool within_budget(const std::vector<NewDetail>& born) const;
  [[nodiscard]] double histogram_distance(int triangle, const std::vector<NewDetail>& born);
  void measure_histogram();

  // Fading one of two close details.
  void merge();
  void fade_one_of(int triangle);
  [[nodiscard]] bool has_ghost(int triangle) const;
  [[nodiscard]] double crowding(int triangle) const;
  [[nodiscard]] double room_of(int site) const;
  [[nodiscard]] int loser(int triangle) const;
  [[nodiscard]] bool may_fade(int site) const;

  SelfReplicatingOptions options_;
  DetailMesh original_;  ///< at rest: what triplets refer to
  DetailMesh now_;
  TripletTable table_;
  AreaBudget budget_;
  PairCorrelation correlation_;
  Eigen::VectorXd histogram_at_rest_, histogram_now_;
  double rest_edge_ = 0;        ///< mean edge of M_d at rest (m)
  double rest_area_ = 0;        ///< mean area of its triangles
  double least_gap_ = 0;        ///< half of the distance of the nearest two at rest (m)
  double area_per_detail_ = 0;  ///< at rest
  StepCounts counts_;
  StepReport report_;
  std::vector<int> mark_;  ///< frame mark of sites whose surroundings changed
  int current_mark_ = 0;
  static constexpr double kNotWanting = std::numeric_limits<double>::infinity();
  std::vector<Need> need_;  ///< of the patches of the sites
  std::vector<int> patch_of_site_;
  std::vector<double> rank_;  ///< of triangles
  std::vector<int> patch_of_triangle_;
  std::vector<WantingTriangle> wanting_;  ///< by patch; those of a patch become a heap
  std::vector<TripletMatch> matches_;
  std::vector<double> distances_;
  std::optional<PointGrid> near_;  ///< details of this frame, when surface is bare
};

/// Centres that stand for all in the histogram of a frame.
constexpr int kHistogramCentres = 512;

bool comes_later(const WantingTriangle& a, const WantingTriangle& b) {
  return a.rank > b.rank || (a.rank == b.rank && a.triangle > b.triangle);
}

/// Averages over neighbours of the density: over some twenty details.
constexpr int kDensityRounds = 2;

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

}  // namespace

SelfReplicating::SelfReplicating(const DetailScene& scene, const SelfReplicatingOptions& options,
                                 std::uint64_t seed)
    : options_(options),
      original_(build_detail_mesh(scene.surface, scene.details)),
      now_(original_),
      table_(original_, options.triplets, seed),
      budget_(original_, options.patch_details) {
  find_all_patches();
  rest_edge_ = mean_edge(original_);
  least_gap_ = 0.5 * shortest_edge(original_);
  double area = 0;
  for (int t = 0; t < original_.mesh.triangle_slots(); ++t)
    if (original_.mesh.triangle_alive(t)) area += original_.mesh.area(t);
  rest_area_ = area / original_.mesh.triangle_count();
  area_per_detail_ = area / original_.detail_count();
  correlation_ = PairCorrelation(rest_edge_, options.pair_correlation);
  if (options_.area_rule == AreaRule::budget) smooth_densities(now_, kDensityRounds);
  if (options_.histogram) histogram_at_rest_ = correlation_.of(original_);
}

double SelfReplicating::wanted_area(int t) const {
  return options_.area_rule == AreaRule::mean ? rest_area_
                                              : details_of(now_, t) / now_.mesh.density(t);
}

double SelfReplicating::ratio(int t) const { return now_.mesh.area(t) / wanted_area(t); }

void SelfReplicating::find_patches(std::span<const int> sites) {
  patch_of_site_.resize(now_.site.size(), -1);
  for (const int i : sites) patch_of_site_[i] = budget_.patch_of(now_.site[i].at);
}

void SelfReplicating::find_all_patches() {
  std::vector<int> all;
  for (int i = 0; i < now_.site_slots(); ++i)
    if (now_.kind[i] != SiteKind::empty) all.push_back(i);
  find_patches(all);
}

void SelfReplicating::find_needs() {
  need_.assign(now_.site.size(), Need::nothing);
  if (options_.area_rule != AreaRule::budget) return;
  for (std::size_t i = 0; i < need_.size(); ++i) {
    const double deficit = budget_.deficit(patch_of_site_[i]);
    if (deficit >= limit()) need_[i] = Need::more;
    if (deficit <= -limit()) need_[i] = Need::fewer;
  }
}

/// Patch of the first corner whose patch has the need; -1 when none has. Rules without a budget
/// know one patch, 0, which always has.
int SelfReplicating::patch_in_need(int t, Need need) const {
  if (options_.area_rule != AreaRule::budget) return 0;
  for (const int c : now_.mesh.corners(t))
    if (static_cast<std::size_t>(c) < need_.size() && need_[c] == need) return patch_of_site(c);
  return -1;
}

/// Ranks all triangles in parallel, and gathers those that want something by their patches.
void SelfReplicating::rank_triangles(Need need, const std::function<double(int)>& rank) {
  wanting_.clear();
  if (options_.area_rule == AreaRule::budget &&
      std::find(need_.begin(), need_.end(), need) == need_.end())
    return;
  rank_.assign(now_.mesh.triangle_slots(), kNotWanting);
  patch_of_triangle_.resize(rank_.size());
  parallel_blocks(rank_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int t = static_cast<int>(i);
      if (!now_.mesh.triangle_alive(t)) continue;
      patch_of_triangle_[i] = patch_in_need(t, need);
      if (patch_of_triangle_[i] >= 0) rank_[i] = rank(t);
    }
  });
  std::vector<int> begin(static_cast<std::size_t>(budget_.patch_count()) + 2, 0);
  const auto each_wanting = [&](const auto& visit) {
    for (std::size_t i = 0; i < rank_.size(); ++i) {
      if (rank_[i] < kNotWanting)
        visit(WantingTriangle{rank_[i], static_cast<int>(i), patch_of_triangle_[i]});
    }
  };
  each_wanting([&](const WantingTriangle& one) { ++begin[one.patch + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  wanting_.resize(begin.back());
  each_wanting([&](const WantingTriangle& one) { wanting_[begin[one.patch]++] = one; });
}

/// Calls `act` for the triangles of each patch, least rank first, while the patch has the need.
void SelfReplicating::act_in_order(Need need, const std::function<void(int)>& act) {
  const bool budget = options_.area_rule == AreaRule::budget;
  for (auto first = wanting_.begin(); first != wanting_.end();) {
    const int patch = first->patch;
    const auto next = std::find_if(first, wanting_.end(),
                                   [&](const WantingTriangle& one) { return one.patch != patch; });
    std::make_heap(first, next, comes_later);
    for (auto end = next; end != first; --end) {
      const double missing = budget_.deficit(patch) * static_cast<double>(need);
      if (budget && missing < limit()) break;
      std::pop_heap(first, end, comes_later);
      act(std::prev(end)->triangle);
    }
    first = next;
  }
}

void SelfReplicating::use_new_marks() { ++current_mark_; }

bool SelfReplicating::marked(int t) const {
  for (const int c : now_.mesh.corners(t))
    if (static_cast<std::size_t>(c) < mark_.size() && mark_[c] == current_mark_) return true;
  return false;
}

void SelfReplicating::mark(int site) {
  if (static_cast<std::size_t>(site) >= mark_.size()) mark_.resize(now_.site_slots(), 0);
  mark_[site] = current_mark_;
}

double SelfReplicating::weight_step(const Eigen::MatrixX3d& V) const {
  if (options_.weight_law == WeightLaw::frame) return options_.weight_rate;
  double largest = 0;
  for (std::size_t v = 0; v < now_.x.size(); ++v) {
    const Eigen::Vector3d shift = V.row(static_cast<Eigen::Index>(v)).transpose() - now_.x[v];
    largest = std::max(largest, shift.norm());
  }
  return std::min(options_.weight_rate, options_.motion_rate * largest / rest_edge_);
}

void SelfReplicating::step(const Eigen::MatrixX3d& V, RunContext& context) {
  counts_ = {};
  report_ = step_details(now_, V, options_.lengths, weight_step(V), context, [&] {
    {
      const Phase phase(context, "insert");
      budget_.update(now_, lead_of(options_.anticipate, options_.weight_rate));
      find_needs();
      if (options_.area_rule == AreaRule::budget)
        counts_.revived = revive_details(now_, budget_, limit());
      insert();
    }
    const Phase phase(context, "merge");
    merge();
  });
}

void SelfReplicating::measure_histogram() {
  const int stride = std::max(1, now_.detail_count() / kHistogramCentres);
  histogram_now_ = correlation_.of(now_, stride);
}

void SelfReplicating::diagnose(std::map<std::string, double>& into) const {
  into["inserted"] = counts_.inserted;
  into["revived"] = counts_.revived;
  into["fading"] = counts_.fading;
  into["flips"] = report_.flips;
  into["failed_queries"] = counts_.failed_queries;
  into["max_weight_change"] = report_.max_weight_change;
  into["refused_flips"] = static_cast<double>(now_.mesh.refused_flips());
  into["budget_target"] = budget_.total_target();
  if (now_.frame > 0) return;
  into["triplets"] = table_.size();
  into["triplets_met"] = static_cast<double>(table_.met());
  into["table_bytes"] = static_cast<double>(table_.bytes());
}

void SelfReplicating::save(StateWriter& out) const {
  now_.save(out);
  budget_.save(out);
}

void SelfReplicating::load(StateReader& in) {
  now_.load(in);
  budget_.load(in);
  budget_.count(now_);
  patch_of_site_.clear();
  find_all_patches();
}

std::unique_ptr<DetailMethod> make_self_replicating(const DetailScene& scene,
                                                    const SelfReplicatingOptions& options,
                                                    std::uint64_t seed) {
  require_valid(scene);
  return std::make_unique<SelfReplicating>(scene, options, seed);
}

std::unique_ptr<Process> make_self_replicating_process(const DetailScene& scene,
                                                       const SelfReplicatingOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext& context) {
    return make_self_replicating(s, options, context.seed());
  });
}

void describe(OptionVisitor& v, TripletOptions& options) {
  v.value("radius", options.radius,
          {.doc = "R: largest edge of a triplet in mean edges of M_d", .min = 1, .max = 10});
  v.value("all", options.all,
          {.doc = "all triplets whatever their size, as the thesis says (at most 400 details)"});
  v.value("interior_only", options.interior_only,
          {.doc = "only triplets with a detail strictly inside"});
  v.value("cells", options.cells, {.doc = "of the grid along either key", .min = 4, .max = 1024});
  v.value("cell_capacity", options.cell_capacity,
          {.doc = "triplets kept in a cell", .min = 1, .max = 1024});
  v.value("max_sources", options.max_sources,
          {.doc = "details whose surroundings are searched for triplets", .min = 1});
  v.value("interior_capacity", options.interior_capacity,
          {.doc = "most details inside a triplet", .min = 1, .max = 64});
}

void describe(OptionVisitor& v, PairCorrelationOptions& options) {
  v.value("radius", options.radius,
          {.doc = "largest distance in mean edges of M_d", .min = 0.5, .max = 10});
  v.value("bins", options.bins, {.doc = "of the distance", .min = 2, .max = 512});
  v.value("bandwidth", options.bandwidth,
          {.doc = "sigma of the Gaussian kernel in mean edges", .min = 0.01, .max = 1});
}

void describe(OptionVisitor& v, SelfReplicatingOptions& options) {
  static constexpr std::array<std::string_view, 3> kAreaRules{"own", "mean", "budget"};
  static constexpr std::array<std::string_view, 2> kWeightLaws{"frame", "motion"};
  describe_choice(v, "area_rule", options.area_rule, kAreaRules,
                  {.doc = "reference area of a triangle: its own, the mean, or a local budget"});
  v.value("stretch_threshold", options.stretch_threshold,
          {.doc = "tau: a triangle is filled above this factor (own, mean)", .min = 1.01});
  v.value(
      "shrink_threshold", options.shrink_threshold,
      {.doc = "tau_c: a triangle loses a detail below 1 / this factor (own, mean)", .min = 1.01});
  v.value("patch_details", options.patch_details,
          {.doc = "budget: details of a patch at rest", .min = 1});
  v.value("dead_band", options.dead_band,
          {.doc = "budget: a patch acts when off by more than 1/2 + this", .min = 0, .max = 10});
  v.value(
      "anticipate", options.anticipate,
      {.doc = "budget: patches ask for what they need K / 4 frames ahead when they grow, 3 K / 4 "
              "when they shrink, K = 1 / weight_rate"});
  v.value("max_insertions", options.max_insertions,
          {.doc = "most details inserted in a frame; absent: no limit", .min = 1});
  describe_choice(v, "weight_law", options.weight_law, kWeightLaws,
                  {.doc = "weights change per frame, or per amount of motion"});
  v.value("weight_rate", options.weight_rate,
          {.doc = "largest change of a weight in a frame", .min = 1e-3, .max = 1});
  v.value("motion_rate", options.motion_rate,
          {.doc = "law motion: change of weight per mean edge of displacement", .min = 0});
  describe_lengths(v, options.lengths);
  v.value("histogram", options.histogram,
          {.doc = "choose among candidate triplets by the pair correlation (the extension)"});
  v.value("candidates", options.candidates,
          {.doc = "m: triplets that the extension compares", .min = 1, .max = 64});
  describe_group(v, "triplets", options.triplets, {.doc = "the table of triplets T"});
  describe_group(v, "pair_correlation", options.pair_correlation,
                 {.doc = "the histogram of the extension"});
}

namespace {

/// Triplets tried for a triangle before it is left for the next frame: copies may land in a patch
/// that has enough.
constexpr int kTries = 4;

}  // namespace

double SelfReplicating::largest_deficit(int t) const {
  double largest = 0;
  for (const int c : now_.mesh.corners(t))
    largest = std::max(largest, budget_.deficit(patch_of_site(c)));
  return largest;
}

void SelfReplicating::insert() {
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

bool SelfReplicating::fill(int t) {
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
      near_->add(now_.position[site],
                 normal_of_face(now_.site[site].at.face, *now_.surface, now_.x));
    budget_.add(patch_of_site(site), 1);
    ++counts_.inserted;
  }
  return true;
}

bool SelfReplicating::within_budget(const std::vector<NewDetail>& born) const {
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
bool SelfReplicating::strays(int t, const std::vector<NewDetail>& born) const {
  const double e01 = now_.mesh.length(3 * t), e12 = now_.mesh.length(3 * t + 1),
               e20 = now_.mesh.length(3 * t + 2);
  const double least = 0.25 * std::min({e01, e12, e20});
  const auto corner = now_.mesh.corners(t);
  return std::any_of(born.begin(), born.end(), [&](const NewDetail& one) {
    const Eigen::Vector3d p = position_of(one.at, *now_.surface, now_.x);
    Eigen::Vector3d on_plane = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k) on_plane += one.barycentric[k] * now_.position[corner[k]];
    if ((p - on_plane).norm() > least) return true;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d v = one.barycentric - Eigen::Vector3d::Unit(k);
      const double flat = std::sqrt(std::max(
          0.0, -(e12 * e12 * v[1] * v[2] + e20 * e20 * v[2] * v[0] + e01 * e01 * v[0] * v[1])));
      const double is = (p - now_.position[corner[k]]).norm();
      if (is < 0.5 * flat || is > 1.5 * flat + least) return true;
    }
    return false;
  });
}

/// Whether a copy is nearer to another detail than half of the nearest two of the original. Asked
/// only where the original leaves surface bare: triangles that span it overlap the pattern, so that
/// what is near in space need not be near in M_d.
bool SelfReplicating::crowds(const std::vector<NewDetail>& born) {
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

std::vector<NewDetail> SelfReplicating::copy_of(const TripletMatch& match, int t) const {
  std::vector<NewDetail> born;
  for (const TripletInterior& inside : table_.interior(match.triplet)) {
    const Eigen::Vector3d b = inside.barycentric();
    NewDetail one;
    for (std::size_t k = 0; k < 3; ++k)
      one.barycentric[static_cast<Eigen::Index>(k)] = b[match.order[k]];
    one.at = surface_point_in(now_, t, one.barycentric);
    one.like = original_.site[inside.detail];
    one.like.weight = 0;
    one.like.target_weight = 1;
    born.push_back(one);
  }
  return born;
}

void SelfReplicating::carry_tangents(const TripletMatch& match, int t,
                                     std::vector<NewDetail>& born) const {
  const auto inside = table_.interior(match.triplet);
  for (std::size_t i = 0; i < born.size(); ++i)
    born[i].like.tangent_angle = carried_angle(match, inside[i].detail, t, born[i].at);
}

/// The tangent keeps its angle to that of the first corner that is a detail (mirrored where the
/// triplet is), so that aligned patterns stay aligned; without one, that to the first corner's
/// direction.
double SelfReplicating::carried_angle(const TripletMatch& match, int source, int t,
                                      const SurfacePoint& at) const {
  const Detail& from = original_.site[source];
  const auto corner_now = now_.mesh.corners(t);
  const auto corner_then = table_.corners(match.triplet);
  const auto tangent = [](const DetailMesh& d, int site) {
    const Detail& s = d.site[site];
    return tangent_direction(s.at.face, s.tangent_angle, *d.surface, d.x);
  };
  Eigen::Vector3d then =
      original_.position[corner_then[match.order[0]]] - original_.position[source];
  Eigen::Vector3d now = now_.position[corner_now[0]] - position_of(at, *now_.surface, now_.x);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!now_.is_detail(corner_now[k])) continue;
    then = tangent(original_, corner_then[match.order[k]]);
    now = tangent(now_, corner_now[k]);
    break;
  }
  const double was = tangent_angle(from.at.face, then, *original_.surface, original_.x);
  const double is = tangent_angle(at.face, now, *now_.surface, now_.x);
  const double offset = from.tangent_angle - was;
  return is + (match.mirrored ? -offset : offset);
}

double SelfReplicating::histogram_distance(int t, const std::vector<NewDetail>& born) {
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

bool SelfReplicating::may_fade(int site) const {
  if (!now_.is_detail(site) || now_.site[site].target_weight == 0) return false;
  return options_.area_rule != AreaRule::budget || budget_.deficit(patch_of_site(site)) <= -limit();
}

bool SelfReplicating::has_ghost(int t) const {
  const auto corner = now_.mesh.corners(t);
  return std::any_of(corner.begin(), corner.end(), [&](int c) { return !now_.is_detail(c); });
}

/// Mean ratio of the triangles among details around one: small where details crowd.
double SelfReplicating::room_of(int site) const {
  const int start = now_.mesh.outgoing(site);
  double sum = 0;
  int count = 0;
  for (int h = start; h >= 0;) {
    if (!has_ghost(h / 3)) {
      sum += ratio(h / 3);
      ++count;
    }
    h = now_.mesh.twin(IntrinsicTriangulation::previous(h));
    if (h == start) break;
  }
  return count > 0 ? sum / count : 1;
}

/// Square of the shortest edge over the area that the triangle should have: small where two details
/// are close. The smallest triangles are slivers as often, which say nothing of distances: in their
/// order the pattern ends farther from the original.
double SelfReplicating::crowding(int t) const {
  const double shortest =
      std::min({now_.mesh.length(3 * t), now_.mesh.length(3 * t + 1), now_.mesh.length(3 * t + 2)});
  return shortest * shortest / wanted_area(t);
}

/// The end of the shortest edge that goes: the younger one. -1 when a detail of the triangle fades
/// already (that makes room), or no end may.
int SelfReplicating::loser(int t) const {
  int shortest = 3 * t;
  for (int h = 3 * t; h < 3 * t + 3; ++h) {
    const int c = now_.mesh.origin(h);
    if (now_.is_detail(c) && now_.site[c].target_weight == 0) return -1;
    if (now_.mesh.length(h) < now_.mesh.length(shortest)) shortest = h;
  }
  const auto age = [&](int i) {
    const Detail& d = now_.site[i];
    return std::tuple(d.weight, room_of(i), -d.birth);
  };
  const int a = now_.mesh.origin(shortest), b = now_.mesh.tip(shortest);
  if (!may_fade(a)) return may_fade(b) ? b : -1;
  if (!may_fade(b)) return a;
  return age(a) < age(b) ? a : b;
}

void SelfReplicating::fade_one_of(int t) {
  const int gone = marked(t) ? -1 : loser(t);
  if (gone < 0) return;
  for (const int c : now_.mesh.corners(t)) mark(c);
  fade_detail(now_, gone, budget_);
  ++counts_.fading;
}

void SelfReplicating::merge() {
  const bool budget = options_.area_rule == AreaRule::budget;
  rank_triangles(Need::fewer, [&](int t) {
    if (has_ghost(t)) return kNotWanting;
    if (!budget && ratio(t) * options_.shrink_threshold >= 1) return kNotWanting;
    return loser(t) >= 0 ? crowding(t) : kNotWanting;
  });
  use_new_marks();
  act_in_order(Need::fewer, [&](int t) { fade_one_of(t); });
}

}  // namespace geoprior::details
