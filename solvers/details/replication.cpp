#include "solvers/details/replication.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/state_bytes.h"
#include "solvers/details/local_density.h"
#include "solvers/details/replication_state.h"

namespace geoprior {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

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

Replication::Replication(const DetailScene& scene, const ReplicationOptions& options,
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

double Replication::wanted_area(int t) const {
  return options_.area_rule == AreaRule::mean ? rest_area_
                                              : details_of(now_, t) / now_.mesh.density(t);
}

double Replication::ratio(int t) const { return now_.mesh.area(t) / wanted_area(t); }

void Replication::find_patches(std::span<const int> sites) {
  patch_of_site_.resize(now_.site.size(), -1);
  for (const int i : sites) patch_of_site_[index(i)] = budget_.patch_of(now_.site[index(i)].at);
}

void Replication::find_all_patches() {
  std::vector<int> all;
  for (int i = 0; i < now_.site_slots(); ++i)
    if (now_.kind[index(i)] != SiteKind::empty) all.push_back(i);
  find_patches(all);
}

void Replication::find_needs() {
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
int Replication::patch_in_need(int t, Need need) const {
  if (options_.area_rule != AreaRule::budget) return 0;
  for (const int c : now_.mesh.corners(t))
    if (index(c) < need_.size() && need_[index(c)] == need) return patch_of_site(c);
  return -1;
}

/// Ranks all triangles in parallel, and gathers those that want something by their patches.
void Replication::rank_triangles(Need need, const std::function<double(int)>& rank) {
  wanting_.clear();
  if (options_.area_rule == AreaRule::budget &&
      std::find(need_.begin(), need_.end(), need) == need_.end())
    return;
  rank_.assign(index(now_.mesh.triangle_slots()), kNotWanting);
  patch_of_triangle_.resize(rank_.size());
  parallel_blocks(rank_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int t = static_cast<int>(i);
      if (!now_.mesh.triangle_alive(t)) continue;
      patch_of_triangle_[i] = patch_in_need(t, need);
      if (patch_of_triangle_[i] >= 0) rank_[i] = rank(t);
    }
  });
  std::vector<int> begin(index(budget_.patch_count()) + 2, 0);
  const auto each_wanting = [&](const auto& visit) {
    for (std::size_t i = 0; i < rank_.size(); ++i) {
      if (rank_[i] < kNotWanting)
        visit(WantingTriangle{rank_[i], static_cast<int>(i), patch_of_triangle_[i]});
    }
  };
  each_wanting([&](const WantingTriangle& one) { ++begin[index(one.patch) + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  wanting_.resize(index(begin.back()));
  each_wanting(
      [&](const WantingTriangle& one) { wanting_[index(begin[index(one.patch)]++)] = one; });
}

/// Calls `act` for the triangles of each patch, least rank first, while the patch has the need.
void Replication::act_in_order(Need need, const std::function<void(int)>& act) {
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

void Replication::use_new_marks() { ++current_mark_; }

bool Replication::marked(int t) const {
  for (const int c : now_.mesh.corners(t))
    if (index(c) < mark_.size() && mark_[index(c)] == current_mark_) return true;
  return false;
}

void Replication::mark(int site) {
  if (index(site) >= mark_.size()) mark_.resize(index(now_.site_slots()), 0);
  mark_[index(site)] = current_mark_;
}

double Replication::weight_step(const Eigen::MatrixX3d& V) const {
  if (options_.weight_law == WeightLaw::frame) return options_.weight_rate;
  double largest = 0;
  for (std::size_t v = 0; v < now_.x.size(); ++v) {
    const Eigen::Vector3d shift = V.row(static_cast<Eigen::Index>(v)).transpose() - now_.x[v];
    largest = std::max(largest, shift.norm());
  }
  return std::min(options_.weight_rate, options_.motion_rate * largest / rest_edge_);
}

void Replication::step(const Eigen::MatrixX3d& V, RunContext& context) {
  counts_ = {};
  const double most = weight_step(V);
  const std::int64_t refused = now_.mesh.refused_flips();
  {
    const Phase phase(context, "move");
    counts_.flips = move_surface(now_, V, options_.lengths);
  }
  {
    const Phase phase(context, "insert");
    const double frames = options_.anticipate ? 1 / options_.weight_rate : 0;
    budget_.update(now_, frames / 4, 3 * frames / 4);
    find_needs();
    if (options_.area_rule == AreaRule::budget) revive();
    insert();
  }
  {
    const Phase phase(context, "merge");
    merge();
  }
  const Phase phase(context, "weights");
  counts_.max_weight_change = change_weights(now_, most);
  // An insertion or a removal may have cleared the way for a flip that was refused before it.
  if (now_.mesh.refused_flips() != refused) counts_.flips += now_.mesh.flip_to_delaunay();
}

void Replication::measure_histogram() {
  const int stride = std::max(1, now_.detail_count() / kHistogramCentres);
  histogram_now_ = correlation_.of(now_, stride);
}

void Replication::diagnose(std::map<std::string, double>& into) const {
  into["inserted"] = counts_.inserted;
  into["revived"] = counts_.revived;
  into["fading"] = counts_.fading;
  into["flips"] = counts_.flips;
  into["failed_queries"] = counts_.failed_queries;
  into["max_weight_change"] = counts_.max_weight_change;
  into["refused_flips"] = static_cast<double>(now_.mesh.refused_flips());
  into["budget_target"] = budget_.total_target();
  if (now_.frame > 0) return;
  into["triplets"] = table_.size();
  into["triplets_met"] = static_cast<double>(table_.met());
  into["table_bytes"] = static_cast<double>(table_.bytes());
}

void Replication::save(StateWriter& out) const {
  now_.save(out);
  budget_.save(out);
}

void Replication::load(StateReader& in) {
  now_.load(in);
  budget_.load(in);
  budget_.count(now_);
  patch_of_site_.clear();
  find_all_patches();
}

std::unique_ptr<DetailMethod> make_replication(const DetailScene& scene,
                                               const ReplicationOptions& options,
                                               std::uint64_t seed) {
  require_valid(scene);
  return std::make_unique<Replication>(scene, options, seed);
}

std::unique_ptr<Process> make_replication_process(const DetailScene& scene,
                                                  const ReplicationOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext& context) {
    return make_replication(s, options, context.seed());
  });
}

}  // namespace geoprior
