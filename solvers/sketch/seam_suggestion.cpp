#include "solvers/sketch/seam_suggestion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "models/sketch/shortest_cut.h"
#include "solvers/sketch/cut_candidates.h"
#include "solvers/sketch/cut_trial.h"
#include "solvers/sketch/random_cuts.h"

namespace geoprior::sketch {
namespace {

/// Of trials; the pattern that is made in the end has its own options.
constexpr int kTrialIterations = 60;
constexpr double kTrialTolerance = 1e-6;

class GreedySuggester {
 public:
  GreedySuggester(const TriMesh& surface, std::span<const SeamEdge> seams,
                const SeamSuggestionOptions& options, const PatternOptions& pattern)
      : options_(options), work_{surface, {seams.begin(), seams.end()}} {
    for (const SeamEdge& e : seams) next_seam_ = std::max(next_seam_, e.seam + 1);
    trial_.pattern = pattern;
    trial_.pattern.flatten.iterations = std::min(pattern.flatten.iterations, kTrialIterations);
    trial_.pattern.flatten.tolerance = std::max(pattern.flatten.tolerance, kTrialTolerance);
    trial_.tolerance = options.tolerance;
    if (options.symmetric) trial_.mirror = mirror_axis(surface);
  }

  std::vector<SuggestedSeam> suggest() {
    std::vector<SuggestedSeam> suggestions;
    while (static_cast<int>(suggestions.size()) < options_.count) {
      std::optional<SuggestedSeam> next = suggest_one();
      if (!next) break;
      suggestions.push_back(std::move(*next));
    }
    return suggestions;
  }

 private:
  struct Scored {
    CutTrial trial;
    double score = 0;
  };

  [[nodiscard]] std::vector<FlatMeasure> measure(const std::vector<CutPiece>& pieces) const;
  std::optional<SuggestedSeam> suggest_one();
  [[nodiscard]] std::optional<Scored> best_cut(const CutPiece& piece,
                                               const FlatMeasure& before) const;
  [[nodiscard]] std::optional<Scored> score(const CutPiece& piece,
                                            const std::vector<SurfacePath>& paths,
                                            const FlatMeasure& before) const;
  [[nodiscard]] std::vector<std::vector<SurfacePath>> candidates(const CutPiece& piece) const;
  std::vector<std::vector<SurfacePath>> apply(const CutPiece& piece, const CutTrial& trial);

  SeamSuggestionOptions options_;
  TrialOptions trial_;
  SeamedSurface work_;
  int next_seam_ = 0;
};

std::vector<FlatMeasure> GreedySuggester::measure(const std::vector<CutPiece>& pieces) const {
  std::vector<FlatMeasure> measures(pieces.size());
  std::vector<std::exception_ptr> errors(pieces.size());
  parallel_blocks(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      try {
        const std::optional<CutTrial> trial = try_cut(pieces[p], {}, trial_);
        if (!trial) throw Error("cannot be cut open", "piece " + std::to_string(p + 1));
        measures[p] = trial->flat;
      } catch (...) {
        errors[p] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
  return measures;
}

/// A closed piece is slit first: its scale is known at a border only.
std::vector<std::vector<SurfacePath>> GreedySuggester::candidates(const CutPiece& piece) const {
  const CutCandidateOptions options{options_.crease, trial_.mirror};
  if (!piece.borders.empty()) return cut_candidates(piece, options);
  std::vector<SeamEdge> slit;
  for (const Edge& e : shortest_cut(piece.mesh)) slit.push_back({e, 0});
  const CutPiece open = cut_surface(piece.mesh, slit).front();
  std::vector<std::vector<SurfacePath>> found = cut_candidates(open, options);
  for (std::vector<SurfacePath>& paths : found) {
    for (SurfacePath& path : paths) path = renumbered(path, open.surface_vertex);
    // What ends on the slit needs the slit.
    for (const SeamEdge& e : slit) paths.push_back({at_vertex(e.edge[0]), at_vertex(e.edge[1])});
  }
  return found;
}

std::optional<GreedySuggester::Scored> GreedySuggester::score(const CutPiece& piece,
                                                          const std::vector<SurfacePath>& paths,
                                                          const FlatMeasure& before) const {
  std::optional<CutTrial> trial;
  try {
    trial = try_cut(piece, paths, trial_);
  } catch (const Error&) {
    return {};  // a part that cannot be laid flat: no suggestion
  }
  if (!trial || (before.sound && !trial->flat.sound)) return {};
  if (trial->length < options_.min_length || trial->length > options_.max_length) return {};
  const double removed = (before.strain - trial->flat.strain) / before.strain;
  const double cost = options_.length_weight * trial->length / std::sqrt(before.area);
  return Scored{std::move(*trial), removed - cost};
}

std::optional<GreedySuggester::Scored> GreedySuggester::best_cut(const CutPiece& piece,
                                                             const FlatMeasure& before) const {
  const std::vector<std::vector<SurfacePath>> all = candidates(piece);
  std::vector<std::optional<Scored>> scored(all.size());
  parallel_blocks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scored[i] = score(piece, all[i], before);
  });
  std::optional<Scored>* best = nullptr;
  for (std::optional<Scored>& candidate : scored) {
    if (candidate && candidate->score > 0 && (!best || candidate->score > (*best)->score))
      best = &candidate;
  }
  if (!best) return {};
  if (options_.rule == SuggestionRule::measured) return std::move(*best);
  const std::vector<SurfacePath> by_lot =
      random_cuts(piece.mesh, (*best)->trial.length, options_.seed);
  std::optional<CutTrial> trial = try_cut(piece, by_lot, trial_);
  if (!trial) return {};
  return Scored{std::move(*trial), 0};
}

/// Repeats the cuts of a trial on the whole surface.
/// @return  the cuts in its numbers
std::vector<std::vector<SurfacePath>> GreedySuggester::apply(const CutPiece& piece,
                                                           const CutTrial& trial) {
  std::vector<int> number = piece.surface_vertex;
  std::vector<std::vector<SurfacePath>> cuts;
  for (const std::vector<SurfacePath>& set : trial.cuts) {
    std::vector<SurfacePath>& cut = cuts.emplace_back();
    for (const SurfacePath& path : set) cut.push_back(renumbered(path, number));
    const int before = work_.mesh.vertex_count();
    if (!work_.cut(cut, next_seam_)) throw Error("a cut of a piece cannot be made on the surface");
    for (int v = before; v < work_.mesh.vertex_count(); ++v) number.push_back(v);
  }
  ++next_seam_;
  return cuts;
}

std::optional<SuggestedSeam> GreedySuggester::suggest_one() {
  const std::vector<CutPiece> pieces = cut_surface(work_.mesh, work_.seams);
  const std::vector<FlatMeasure> measures = measure(pieces);
  FlatMeasure whole;
  for (const FlatMeasure& m : measures) whole.add(m);
  if (!(whole.within < options_.share * whole.area)) return {};
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return measures[a].strain > measures[b].strain;
  });
  for (const std::size_t p : order) {
    if (!(measures[p].within < measures[p].area)) continue;
    std::optional<Scored> best = best_cut(pieces[p], measures[p]);
    if (!best) continue;
    SuggestedSeam suggestion;
    const FlatMeasure& now = best->trial.flat;
    suggestion.is_dart = best->trial.parts == 1 && best->trial.cuts.size() == 1;
    suggestion.share_before = whole.within / whole.area;
    suggestion.strain_before = whole.strain / whole.area;
    suggestion.share_after = (whole.within - measures[p].within + now.within) / whole.area;
    suggestion.strain_after = (whole.strain - measures[p].strain + now.strain) / whole.area;
    suggestion.length = best->trial.length;
    suggestion.lines = best->trial.lines;
    suggestion.normals = best->trial.normals;
    suggestion.cuts = apply(pieces[p], best->trial);
    return suggestion;
  }
  return {};
}

}  // namespace

void describe(OptionVisitor& v, SeamSuggestionOptions& o) {
  static constexpr std::array<std::string_view, 2> kRules{"measured", "chance"};
  v.value("tolerance", o.tolerance,
          {.doc = "stretch that the pattern may have", .min = 1e-6, .max = 1});
  v.value("share", o.share,
          {.doc = "of the area within the tolerance, at which nothing more is suggested",
           .min = 0,
           .max = 1});
  v.value("count", o.count, {.doc = "most suggestions", .min = 0, .max = 100});
  v.value("min_length", o.min_length,
          {.doc = "of all cuts of a suggestion", .unit = "m", .min = 0});
  v.value("max_length", o.max_length,
          {.doc = "of all cuts of a suggestion", .unit = "m", .min = 0});
  v.value("length_weight", o.length_weight,
          {.doc = "share of the error that a cut as long as the root of the piece's area has to "
                  "remove to be worth it",
           .min = 0});
  v.value("crease", o.crease,
          {.doc = "how much cheaper cuts are along lines of concentrated curvature",
           .min = 0,
           .max = 100});
  v.value("symmetric", o.symmetric, {.doc = "mirrored surfaces get mirrored suggestions"});
  describe_choice(v, "rule", o.rule, kRules, {.doc = "where suggested cuts lie"});
  v.value("seed", o.seed, {.doc = "of chance", .min = 0});
}

std::vector<SuggestedSeam> suggest_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                                         const SeamSuggestionOptions& options,
                                         const PatternOptions& pattern) {
  return GreedySuggester(surface, seams, options, pattern).suggest();
}

}  // namespace geoprior::sketch
