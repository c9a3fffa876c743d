#include "solvers/details/replication.h"

#include <algorithm>

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

}  // namespace

Replication::Replication(const DetailScene& scene, const ReplicationOptions& options,
                         std::uint64_t seed)
    : options_(options),
      original_(build_detail_mesh(scene.surface, scene.details)),
      now_(original_),
      table_(original_, options.triplets, seed),
      budget_(original_, options.patch_details) {
  rest_edge_ = mean_edge(original_);
  double area = 0;
  for (int t = 0; t < original_.mesh.triangle_slots(); ++t)
    if (original_.mesh.triangle_alive(t)) area += original_.mesh.area(t);
  rest_area_ = area / original_.mesh.triangle_count();
  correlation_ = PairCorrelation(rest_edge_, options.pair_correlation);
  if (options_.area_rule == AreaRule::budget) smooth_densities(now_, kDensityRounds);
  if (options_.histogram) histogram_at_rest_ = correlation_.of(original_);
}

double Replication::ratio(int t) const {
  const double area = now_.mesh.area(t);
  return options_.area_rule == AreaRule::mean ? area / rest_area_
                                              : now_.mesh.density(t) * area / details_of(now_, t);
}

void Replication::find_needs() {
  need_.assign(now_.site.size(), Need::nothing);
  if (options_.area_rule != AreaRule::budget) return;
  parallel_blocks(need_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (now_.kind[i] == SiteKind::empty) continue;
      const double deficit = budget_.deficit(budget_.patch_of(now_.site[i].at));
      if (deficit >= limit()) need_[i] = Need::more;
      if (deficit <= -limit()) need_[i] = Need::fewer;
    }
  });
}

bool Replication::any_corner(int t, Need need) const {
  const auto corner = now_.mesh.corners(t);
  return std::any_of(corner.begin(), corner.end(),
                     [&](int c) { return index(c) < need_.size() && need_[index(c)] == need; });
}

/// Ranks all triangles in parallel, and gathers those that want something.
void Replication::rate_triangles(const std::function<double(int)>& rank) {
  rank_.assign(index(now_.mesh.triangle_slots()), kNotWanting);
  parallel_blocks(rank_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (now_.mesh.triangle_alive(static_cast<int>(t))) rank_[t] = rank(static_cast<int>(t));
  });
  wanting_.clear();
  for (std::size_t t = 0; t < rank_.size(); ++t)
    if (rank_[t] < kNotWanting) wanting_.push_back({rank_[t], static_cast<int>(t)});
  std::make_heap(wanting_.begin(), wanting_.end(), comes_later);
}

int Replication::next_wanting() {
  std::pop_heap(wanting_.begin(), wanting_.end(), comes_later);
  const int t = wanting_.back().triangle;
  wanting_.pop_back();
  return t;
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
  {
    const Phase phase(context, "move");
    counts_.flips = move_surface(now_, V, options_.lengths);
  }
  {
    const Phase phase(context, "insert");
    const double frames = options_.anticipate ? 1 / options_.weight_rate : 0;
    budget_.update(now_, frames / 4, 3 * frames / 4);
    if (options_.area_rule == AreaRule::budget) revive();
    find_needs();
    insert();
  }
  {
    const Phase phase(context, "merge");
    merge();
  }
  const Phase phase(context, "weights");
  counts_.max_weight_change = change_weights(now_, most);
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
  out.items(budget_.areas());
}

void Replication::load(StateReader& in) {
  now_.load(in);
  std::vector<double> areas;
  in.items(areas);
  budget_.set_areas(std::move(areas));
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
