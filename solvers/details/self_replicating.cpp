#include "solvers/details/self_replicating.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/parallel.h"
#include "core/state_bytes.h"
#include "models/details/area_budget.h"
#include "models/details/step.h"
#include "solvers/details/local_density.h"

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
  void fill(int triangle);
  [[nodiscard]] bool within_budget(const std::vector<NewDetail>& born) const;

  // Fading one of two close details.
  void merge();
  void fade_one_of(int triangle);
  [[nodiscard]] bool has_ghost(int triangle) const;
  [[nodiscard]] double crowding(int triangle) const;
  [[nodiscard]] double room_of(int site) const;
  [[nodiscard]] int loser(int triangle) const;
  [[nodiscard]] bool may_fade(int site) const;

  SelfReplicatingOptions options_;
  DetailMesh now_;
  AreaBudget budget_;
  PatternCopier copier_;
  double rest_edge_ = 0;  ///< mean edge of M_d at rest (m)
  double rest_area_ = 0;  ///< mean area of its triangles (m^2)
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
};

bool comes_later(const WantingTriangle& a, const WantingTriangle& b) {
  return a.rank > b.rank || (a.rank == b.rank && a.triangle > b.triangle);
}

/// Averages over neighbours of the density: over some twenty details.
constexpr int kDensityRounds = 2;

}  // namespace

SelfReplicating::SelfReplicating(const DetailScene& scene, const SelfReplicatingOptions& options,
                                 std::uint64_t seed)
    : options_(options),
      now_(build_detail_mesh(scene.surface, scene.details)),
      budget_(now_, options.patch_details),
      copier_(now_, options.copies, budget_.leaves_bare(), seed),
      rest_edge_(mean_edge(now_)),
      rest_area_(total_area(now_) / now_.mesh.triangle_count()) {
  find_all_patches();
  if (options_.area_rule == AreaRule::budget) smooth_densities(now_, kDensityRounds);
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
    for (int i = 0; i < std::ssize(rank_); ++i) {
      if (rank_[i] < kNotWanting) visit(WantingTriangle{rank_[i], i, patch_of_triangle_[i]});
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
    const Eigen::Vector3d shift = V.row(v).transpose() - now_.x[v];
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
  into["triplets"] = copier_.table().size();
  into["triplets_met"] = static_cast<double>(copier_.table().met());
  into["table_bytes"] = static_cast<double>(copier_.table().bytes());
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

void describe(OptionVisitor& v, SelfReplicatingOptions& options) {
  static constexpr std::array<std::string_view, 3> kAreaRules{"own", "mean", "budget"};
  static constexpr std::array<std::string_view, 2> kWeightLaws{"frame", "motion"};
  describe_choice(
      v, "area_rule", options.area_rule, kAreaRules,
      {.doc = "area that a triangle is held against: its own at first, the mean, or that "
              "of a patch's budget"});
  v.value("stretch_threshold", options.stretch_threshold,
          {.doc = "tau: a triangle above this multiple of its area is filled (rules own, mean)",
           .min = 1.01});
  v.value("shrink_threshold", options.shrink_threshold,
          {.doc = "tau_c: a triangle below its area / tau_c loses a detail (rules own, mean)",
           .min = 1.01});
  v.value("patch_details", options.patch_details,
          {.doc = "details of a patch at rest (rule budget)", .min = 1});
  v.value("dead_band", options.dead_band,
          {.doc = "a patch acts when its details are off by more than 1/2 + this (rule budget)",
           .min = 0,
           .max = 10});
  v.value("anticipate", options.anticipate,
          {.doc = "growing patches ask K / 4 frames ahead, shrinking ones 3 K / 4, with "
                  "K = 1 / weight_rate (rule budget)"});
  describe_choice(v, "weight_law", options.weight_law, kWeightLaws,
                  {.doc = "weights change by the frame, or by the motion of the surface"});
  v.value("weight_rate", options.weight_rate,
          {.doc = "largest change of a weight in a frame", .min = 1e-3, .max = 1});
  v.value(
      "motion_rate", options.motion_rate,
      {.doc = "change of a weight while the surface moves by a mean edge (law motion)", .min = 0});
  describe_lengths(v, options.lengths);
  describe(v, options.copies);
}

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
  copier_.begin_frame(now_);
  use_new_marks();
  act_in_order(Need::more, [&](int t) {
    // A triangle that an insertion of this frame rewrote has a corner that is marked.
    if (now_.mesh.triangle_alive(t) && !marked(t)) fill(t);
  });
}

void SelfReplicating::fill(int t) {
  const bool budget = options_.area_rule == AreaRule::budget;
  int room = std::numeric_limits<int>::max();
  if (budget) {
    const double deficit = largest_deficit(t);
    if (deficit < limit()) return;  // met by an insertion of this frame
    room = std::max(1, static_cast<int>(deficit + 0.5));
  }
  const auto copies = copier_.copies_for(now_, t, room, [&](const std::vector<NewDetail>& born) {
    return !budget || within_budget(born);
  });
  if (!copies) ++counts_.failed_queries;
  if (!copies || copies->empty()) return;
  for (const int c : now_.mesh.corners(t)) mark(c);
  const std::vector<int> sites = insert_details(now_, t, *copies);
  find_patches(sites);
  for (const int site : sites) {
    mark(site);
    copier_.add(now_, site);
    budget_.add(patch_of_site(site), 1);
    ++counts_.inserted;
  }
}

bool SelfReplicating::within_budget(const std::vector<NewDetail>& born) const {
  for (std::size_t i = 0; i < born.size(); ++i) {
    const int patch = budget_.patch_of(born[i].at);
    const auto before = std::count_if(born.begin(), born.begin() + i, [&](const NewDetail& other) {
      return budget_.patch_of(other.at) == patch;
    });
    if (budget_.deficit(patch) - static_cast<double>(before) < limit()) return false;
  }
  return true;
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
