#include "solvers/sketch/pattern/seam_suggestion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "models/sketch/surface/shortest_cut.h"
#include "solvers/sketch/pattern/cut_candidates.h"
#include "solvers/sketch/pattern/cut_trial.h"
#include "solvers/sketch/pattern/fair_seams.h"
#include "solvers/sketch/pattern/random_cuts.h"

namespace geoprior::sketch {
namespace {

/// Length of all cuts of a suggestion: shorter ones are not worth sewing, longer ones are not of
/// anything that is sewn (m). Ours.
constexpr double kShortestSuggestion = 0.02, kLongestSuggestion = 10;
constexpr int kBranches = 4;             ///< further cuts that are tried of each plan
constexpr double kSameScore = 0.02;      ///< cuts nearer than this in error and length are the same
constexpr double kSamePlan = 1e-3;       ///< plans nearer than this in price and share are the same
constexpr double kCutPrice = 0.03;       ///< of a suggestion, in the logarithm of the error
constexpr double kUnsoundPrice = 1;      ///< of parts that lie on each other, in the same
constexpr double kMissingPrice = 5;      ///< of the whole area, of which `share` still lacks a part
constexpr double kTurningPrice = 0.005;  ///< of a radian that a cut turns by
constexpr double kNear = 0.03;  ///< of mirror images, in diagonals of the surface and in area
constexpr double kLopsidedPrice = 0.02;  ///< of cuts that are not their own mirror image
constexpr double kLeastStrain = 1e-4;    ///< mean |log stretch| that is as good as none
constexpr double kLineWidth = 4;  ///< scale at which the lines of suggestions are fair (mean edges)

/// A surface with the suggestions that were cut into it.
struct Plan {
  SeamedSurface work;
  int next_seam = 0;
  std::vector<SuggestedSeam> suggestions;
  std::vector<Panel> panels;
  std::vector<std::string> keys;   ///< of the panels: `key_of`
  std::vector<CutTrial> measures;  ///< of the panels as they are
  FlatMeasure whole;               ///< of all of them
  double seams = 0;                ///< what the suggestions cost beside their length
  double price = 0;                ///< the less, the better
};

/// Of cuts, the best first, those that leave the piece otherwise than the ones before.
template <typename Scored>
void keep_apart(std::vector<Scored>& cuts) {
  std::vector<Scored> apart;
  for (Scored& cut : cuts) {
    const bool is_new = std::none_of(apart.begin(), apart.end(), [&](const Scored& other) {
      return std::abs(other.trial.flat.strain - cut.trial.flat.strain) <
                 kSameScore * other.trial.flat.strain &&
             std::abs(other.trial.lines.length - cut.trial.lines.length) <
                 kSameScore * other.trial.lines.length;
    });
    if (is_new) apart.push_back(std::move(cut));
  }
  cuts = std::move(apart);
}

/// The bytes of what a trial depends on: plans have most of their panels in common.
std::string key_of(const Panel& panel) {
  std::string key;
  const auto append = [&key](const auto* data, Eigen::Index count) {
    key.append(reinterpret_cast<const char*>(data),
               sizeof(*data) * static_cast<std::size_t>(count));
  };
  append(panel.piece.mesh.V.data(), panel.piece.mesh.V.size());
  append(panel.piece.mesh.F.data(), panel.piece.mesh.F.size());
  for (const SeamEdge& e : panel.inner) append(e.edge.data(), 2);
  return key;
}

std::pair<double, Eigen::RowVector3d> area_and_centre(const TriMesh& mesh) {
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) sum += areas(t) / 3 * mesh.V.row(mesh.F(t, k));
  }
  return {areas.sum(), sum / areas.sum()};
}

/// The middle of lines, by their length.
Eigen::RowVector3d middle_of(const CutLines& lines) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (const Eigen::MatrixX3d& x : lines.points) {
    for (Eigen::Index k = 1; k < x.rows(); ++k)
      sum += (x.row(k) - x.row(k - 1)).norm() * (x.row(k) + x.row(k - 1)) / 2;
  }
  return sum / lines.length;
}

/// How much lines turn, closed ones where they close too (rad).
double turning_of(const CutLines& lines) {
  double turning = 0;
  const auto between = [](const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
  };
  for (const Eigen::MatrixX3d& x : lines.points) {
    const Eigen::Index last = x.rows() - 1;
    for (Eigen::Index k = 1; k < last; ++k)
      turning += between(x.row(k) - x.row(k - 1), x.row(k + 1) - x.row(k));
    if (last > 1 && x.row(0) == x.row(last))
      turning += between(x.row(last) - x.row(last - 1), x.row(1) - x.row(0));
  }
  return turning;
}

class SuggestionSearch {
 public:
  SuggestionSearch(const TriMesh& surface, std::span<const SeamEdge> seams,
                   const SeamSuggestionOptions& options, const PatternOptions& pattern)
      : options_(options), most_pieces_(pattern.most_pieces) {
    first_.work = {surface, {seams.begin(), seams.end()}};
    for (const SeamEdge& e : seams) first_.next_seam = std::max(first_.next_seam, e.seam + 1);
    trial_ = trial_options(pattern, options.tolerance);
    if (options.symmetric) trial_.mirror = mirror_axis(surface);
    whole_ = triangle_areas(surface.V, surface.F).sum();
    diagonal_ = bounding_box_diagonal(surface.V);
    line_width_ = kLineWidth * mean_edge_length(surface.V, EdgeConnectivity(surface.F));
  }

  std::vector<SuggestedSeam> suggest();

 private:
  struct Scored {
    CutTrial trial;
    double score = 0;
  };

  void measure(Plan& plan);
  /// Whether a place lies in the mirror plane of the surface.
  [[nodiscard]] bool is_centred(const Eigen::RowVector3d& x) const {
    return (trial_.mirror->mirrored(x) - x).norm() < kNear * diagonal_;
  }
  [[nodiscard]] bool is_enough(const Plan& plan) const {
    return plan.whole.sound && !(plan.whole.within < options_.share * plan.whole.area);
  }
  /// Of a piece that is its own mirror image, cuts beside the plane.
  [[nodiscard]] bool is_lopsided(const TriMesh& piece, const CutLines& lines) const {
    return trial_.mirror && is_centred(area_and_centre(piece).second) &&
           !is_centred(middle_of(lines));
  }
  [[nodiscard]] std::vector<Plan> continued(const Plan& plan);
  void keep_different(std::vector<Plan>& plans) const;
  const std::vector<Scored>& cuts_of(const Plan& plan, std::size_t p);
  [[nodiscard]] std::vector<Scored> best_cuts(const Panel& piece, const CutTrial& before,
                                              const TrialOptions& options) const;
  [[nodiscard]] std::optional<Scored> score(const Panel& piece,
                                            const std::vector<SurfacePath>& paths,
                                            const CutTrial& before,
                                            const TrialOptions& options) const;
  [[nodiscard]] std::vector<std::vector<SurfacePath>> candidates(const Panel& panel) const;
  [[nodiscard]] std::optional<std::size_t> mirror_image(const std::vector<Panel>& pieces,
                                                        std::size_t piece) const;
  [[nodiscard]] SuggestedSeam suggestion_of(const Plan& plan, std::size_t p,
                                            const CutTrial& best) const;
  [[nodiscard]] std::optional<Plan> applied(const Plan& plan, SuggestedSeam suggestion);

  SeamSuggestionOptions options_;
  TrialOptions trial_;
  Plan first_;
  double whole_ = 0;                                           ///< area of the surface (m^2)
  double diagonal_ = 0;                                        ///< m
  double line_width_ = 0;                                      ///< m
  int most_pieces_ = 0;                                        ///< 0: any number
  std::unordered_map<std::string, CutTrial> measures_;         ///< by `key_of`
  std::unordered_map<std::string, std::vector<Scored>> cuts_;  ///< by `key_of`
};

/// Every piece as it is, and the price of all: the logarithm of the error, so that what halves it
/// is worth as much early and late, with what length and number of pieces cost.
void SuggestionSearch::measure(Plan& plan) {
  plan.panels = panels_of(plan.work);
  plan.keys.clear();
  std::vector<Panel> unknown;
  std::vector<std::string> keys;
  for (const Panel& panel : plan.panels) {
    const std::string& key = plan.keys.emplace_back(key_of(panel));
    if (measures_.contains(key)) continue;
    unknown.push_back(panel);
    keys.push_back(key);
  }
  std::vector<CutTrial> measured = measured_panels(unknown, trial_);
  for (std::size_t i = 0; i < keys.size(); ++i) measures_.emplace(keys[i], std::move(measured[i]));
  plan.measures.clear();
  for (const std::string& key : plan.keys) plan.measures.push_back(measures_.at(key));
  plan.whole = {};
  double length = 0;
  for (const CutTrial& m : plan.measures) {
    plan.whole.add(m.flat);
    length += m.opening_length;
  }
  for (const SuggestedSeam& seam : plan.suggestions) length += seam.lines.length;
  plan.price = std::log(std::max(plan.whole.strain / plan.whole.area, kLeastStrain)) +
               options_.length_weight * length / std::sqrt(whole_) +
               options_.piece_weight * static_cast<double>(plan.panels.size()) + plan.seams +
               kMissingPrice * std::max(0.0, options_.share - plan.whole.within / plan.whole.area) +
               (plan.whole.sound ? 0 : kUnsoundPrice);
}

/// Of the panel with its own seams closed, and of what it is when they are open: a loop may cross
/// them, a dart may end on them.
std::vector<std::vector<SurfacePath>> SuggestionSearch::candidates(const Panel& panel) const {
  const CutCandidateOptions options{trial_.mirror, options_.fair};
  std::vector<std::vector<SurfacePath>> found;
  if (!panel.piece.borders.empty()) found = cut_candidates(panel.piece, options);
  // A closed piece is slit first: its scale is known at a border only.
  std::vector<SeamEdge> open = panel.inner, slit;
  if (panel.piece.borders.empty() && open.empty()) {
    for (const Edge& e : shortest_cut(panel.piece.mesh)) slit.push_back({e, 0});
    open = slit;
  }
  if (open.empty()) return found;
  const CutPiece opened = cut_surface(panel.piece.mesh, open).front();
  for (std::vector<SurfacePath>& paths : cut_candidates(opened, options)) {
    for (SurfacePath& path : paths) path = renumbered(path, opened.surface_vertex);
    // What ends on the slit needs the slit.
    for (const SeamEdge& e : slit) paths.push_back({at_vertex(e.edge[0]), at_vertex(e.edge[1])});
    found.push_back(std::move(paths));
  }
  return found;
}

std::optional<SuggestionSearch::Scored> SuggestionSearch::score(
    const Panel& piece, const std::vector<SurfacePath>& paths, const CutTrial& before,
    const TrialOptions& options) const {
  std::optional<CutTrial> trial;
  try {
    trial = try_cut(piece, paths, options);
  } catch (const Error&) {
    return {};  // a part that cannot be laid flat: no suggestion
  }
  if (!trial || (before.flat.sound && !trial->flat.sound)) return {};
  if (trial->least_part < std::min(before.least_part, options_.min_part * whole_)) return {};
  const double added = trial->lines.length;
  if (added < kShortestSuggestion || added > kLongestSuggestion) return {};
  const double least = kLeastStrain * before.flat.area;
  const double removed =
      1 - std::max(trial->flat.strain, least) / std::max(before.flat.strain, least);
  const double opened = std::max(0.0, trial->opening_length - before.opening_length);
  const double cost = options_.length_weight * (added + opened) / std::sqrt(before.flat.area) +
                      kTurningPrice * turning_of(trial->lines) +
                      options_.piece_weight * (trial->parts - before.parts) +
                      (is_lopsided(piece.piece.mesh, trial->lines) ? kLopsidedPrice : 0);
  const double mended = !before.flat.sound && trial->flat.sound ? kUnsoundPrice : 0;
  return Scored{std::move(*trial), removed - cost + mended};
}

/// `best_cuts` that leave no more pieces than are wanted; found once of a piece that several plans
/// have.
const std::vector<SuggestionSearch::Scored>& SuggestionSearch::cuts_of(const Plan& plan,
                                                                       std::size_t p) {
  TrialOptions options = trial_;
  if (most_pieces_ > 0) {
    const int others = static_cast<int>(plan.panels.size()) - 1;
    options.most_parts = std::max(plan.measures[p].parts, most_pieces_ - others);
  }
  const std::string key = plan.keys[p] + std::to_string(options.most_parts);
  const auto known = cuts_.find(key);
  if (known != cuts_.end()) return known->second;
  return cuts_.emplace(key, best_cuts(plan.panels[p], plan.measures[p], options)).first->second;
}

/// Those that ease the piece for what they cost, the best first.
std::vector<SuggestionSearch::Scored> SuggestionSearch::best_cuts(
    const Panel& piece, const CutTrial& before, const TrialOptions& options) const {
  const std::vector<std::vector<SurfacePath>> all = candidates(piece);
  std::vector<std::optional<Scored>> scored(all.size());
  parallel_blocks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scored[i] = score(piece, all[i], before, options);
  });
  std::vector<Scored> best;
  for (std::optional<Scored>& candidate : scored) {
    if (candidate && candidate->score > 0) best.push_back(std::move(*candidate));
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const Scored& a, const Scored& b) { return a.score > b.score; });
  keep_apart(best);
  if (best.empty() || options_.rule == SuggestionRule::measured) return best;
  const std::vector<SurfacePath> by_lot =
      random_cuts(piece.piece.mesh, best.front().trial.lines.length, options_.seed);
  std::optional<CutTrial> trial = try_cut(piece, by_lot, options);
  best.clear();
  if (trial) best.push_back({std::move(*trial), 0});
  return best;
}

/// The other piece that lies where the image of this one is, with about its area.
std::optional<std::size_t> SuggestionSearch::mirror_image(const std::vector<Panel>& pieces,
                                                          std::size_t piece) const {
  if (!trial_.mirror || options_.rule != SuggestionRule::measured) return {};
  const auto [area, centre] = area_and_centre(pieces[piece].piece.mesh);
  if (is_centred(centre)) return {};  // its own image
  const Eigen::RowVector3d image = trial_.mirror->mirrored(centre);
  for (std::size_t other = 0; other < pieces.size(); ++other) {
    if (other == piece) continue;
    const auto [other_area, other_centre] = area_and_centre(pieces[other].piece.mesh);
    if ((other_centre - image).norm() < kNear * diagonal_ &&
        std::abs(other_area - area) < kNear * area) {
      return other;
    }
  }
  return {};
}

/// The plan with a further cut, which is in the numbers of the whole surface, unless that leaves a
/// crumb or too many pieces.
std::optional<Plan> SuggestionSearch::applied(const Plan& plan, SuggestedSeam suggestion) {
  const auto least_piece = [](const SeamedSurface& surface) {
    double least = std::numeric_limits<double>::infinity();
    for (const CutPiece& piece : cut_surface(surface.mesh, surface.seams))
      least = std::min(least, triangle_areas(piece.mesh.V, piece.mesh.F).sum());
    return least;
  };
  Plan further{plan.work, plan.next_seam + 1, plan.suggestions, {}, {}, {}, {}, plan.seams, 0};
  if (!further.work.cut(suggestion.cut, plan.next_seam)) return {};
  if (most_pieces_ > 0 &&
      std::ssize(cut_surface(further.work.mesh, further.work.seams)) > most_pieces_) {
    return {};
  }
  SeamedSurface opened = further.work;
  if (std::optional<Openings> openings = open_rings(opened, further.next_seam, trial_)) {
    suggestion.openings = std::move(openings->cuts);
    suggestion.opening_lines = std::move(openings->lines);
  }
  const bool crumbs =
      least_piece(opened) < std::min(least_piece(plan.work), options_.min_part * whole_);
  if (crumbs && options_.rule == SuggestionRule::measured) return {};
  further.seams += kCutPrice + kTurningPrice * turning_of(suggestion.lines);
  if (trial_.mirror && !is_centred(middle_of(suggestion.lines))) further.seams += kLopsidedPrice;
  if (options_.fair) {
    suggestion.lines = faired_lines(suggestion.lines, line_width_);
    suggestion.opening_lines = faired_lines(suggestion.opening_lines, line_width_);
  }
  further.suggestions.push_back(std::move(suggestion));
  measure(further);
  SuggestedSeam& last = further.suggestions.back();
  last.share_before = plan.whole.within / plan.whole.area;
  last.strain_before = plan.whole.strain / plan.whole.area;
  last.share_after = further.whole.within / further.whole.area;
  last.strain_after = further.whole.strain / further.whole.area;
  return further;
}

/// The cut of a piece, and of the piece that is its mirror image.
SuggestedSeam SuggestionSearch::suggestion_of(const Plan& plan, std::size_t p,
                                              const CutTrial& best) const {
  SuggestedSeam suggestion;
  const auto take = [&](std::size_t piece, const CutTrial& trial) {
    suggestion.lines.append(trial.lines);
    for (const SurfacePath& path : trial.cut)
      suggestion.cut.push_back(renumbered(path, plan.panels[piece].piece.surface_vertex));
  };
  suggestion.is_dart = best.parts == 1;
  if (const std::optional<std::size_t> image = mirror_image(plan.panels, p)) {
    const std::vector<SurfacePath> cut = mirrored_cut(
        plan.panels[p].piece, plan.panels[*image].piece, best.cut, {trial_.mirror, options_.fair});
    std::optional<Scored> mirrored;
    if (!cut.empty()) mirrored = score(plan.panels[*image], cut, plan.measures[*image], trial_);
    if (mirrored) take(*image, mirrored->trial);
  }
  take(p, best);
  return suggestion;
}

/// The plan with one cut more, of the piece that is strained most among those that can be cut.
std::vector<Plan> SuggestionSearch::continued(const Plan& plan) {
  std::vector<std::size_t> order(plan.panels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const FlatMeasure &of_a = plan.measures[a].flat, &of_b = plan.measures[b].flat;
    return std::pair(!of_a.sound, of_a.strain) > std::pair(!of_b.sound, of_b.strain);
  });
  std::vector<Plan> plans;
  for (const std::size_t p : order) {
    const FlatMeasure& then = plan.measures[p].flat;
    if (then.sound && !(then.within < then.area)) continue;
    for (const Scored& best : cuts_of(plan, p)) {
      if (std::ssize(plans) >= kBranches) break;
      std::optional<Plan> further = applied(plan, suggestion_of(plan, p, best.trial));
      if (further) plans.push_back(std::move(*further));
    }
    if (!plans.empty()) break;
  }
  return plans;
}

/// Plans that come to the same, by other cuts or in another order, are one.
void SuggestionSearch::keep_different(std::vector<Plan>& plans) const {
  const auto same = [](const Plan& a, const Plan& b) {
    return std::abs(a.price - b.price) < kSamePlan &&
           std::abs(a.whole.within - b.whole.within) < kSamePlan * a.whole.area;
  };
  std::vector<Plan> different;
  for (Plan& plan : plans) {
    const bool is_new = std::none_of(different.begin(), different.end(),
                                     [&](const Plan& other) { return same(plan, other); });
    if (is_new) different.push_back(std::move(plan));
    if (std::ssize(different) == options_.plans) break;
  }
  plans = std::move(different);
}

/// Until a plan is enough, or the best of them is no better than the one that it was made of.
std::vector<SuggestedSeam> SuggestionSearch::suggest() {
  measure(first_);
  std::vector<Plan> plans{first_};
  const auto cheaper = [](const Plan& a, const Plan& b) { return a.price < b.price; };
  for (int step = 0; step < options_.count && !is_enough(plans.front()); ++step) {
    std::vector<Plan> next;
    for (const Plan& plan : plans) {
      std::vector<Plan> further = continued(plan);
      next.insert(next.end(), std::make_move_iterator(further.begin()),
                  std::make_move_iterator(further.end()));
    }
    std::stable_sort(next.begin(), next.end(), cheaper);
    std::stable_partition(next.begin(), next.end(),
                          [&](const Plan& plan) { return is_enough(plan); });
    if (next.empty()) break;
    const bool better = is_enough(next.front()) || cheaper(next.front(), plans.front());
    if (!better && options_.rule == SuggestionRule::measured) break;
    keep_different(next);
    plans = std::move(next);
  }
  return plans.front().suggestions;
}

}  // namespace

void describe(OptionVisitor& v, SeamSuggestionOptions& o) {
  static constexpr std::array<std::string_view, 2> kRules{"measured", "chance"};
  v.value("tolerance", o.tolerance,
          {.doc = "stretch that the pattern may have", .min = 1e-6, .max = 1});
  v.value("share", o.share,
          {.doc = "share of the area within the tolerance at which nothing more is suggested",
           .min = 0,
           .max = 1});
  v.value("count", o.count, {.doc = "most suggestions that are made", .min = 0, .max = 100});
  v.value("length_weight", o.length_weight,
          {.doc = "share of the error that a cut as long as the root of a piece's area must remove",
           .min = 0});
  v.value(
      "piece_weight", o.piece_weight,
      {.doc = "share of the error that a cut must remove for each piece that it adds", .min = 0});
  v.value(
      "plans", o.plans,
      {.doc = "sets of suggestions that are followed at once; 1: the best cut, and on from there",
       .min = 1,
       .max = 100});
  v.value("min_part", o.min_part,
          {.doc = "least area of a piece, over that of the surface, that suggestions may leave",
           .min = 0,
           .max = 1});
  v.value("fair", o.fair,
          {.doc = "whether suggested seams are made fair; otherwise they stay as they were found"});
  v.value("symmetric", o.symmetric, {.doc = "whether mirrored surfaces get mirrored suggestions"});
  describe_choice(v, "rule", o.rule, kRules, {.doc = "where suggested cuts lie"});
  v.value("seed", o.seed, {.doc = "seed of cuts by chance", .min = 0});
}

std::vector<SuggestedSeam> suggest_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                                         const SeamSuggestionOptions& options,
                                         const PatternOptions& pattern) {
  return SuggestionSearch(surface, seams, options, pattern).suggest();
}

}  // namespace geoprior::sketch
