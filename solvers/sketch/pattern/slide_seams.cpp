#include "solvers/sketch/pattern/slide_seams.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "solvers/sketch/pattern/cut_trial.h"
#include "solvers/sketch/pattern/fair_seams.h"

namespace geoprior::sketch {
namespace {

/// Share of the area that all fair seams together may cost.
constexpr double kMostLost = 0.01;

}  // namespace

TriMesh slide_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                    std::span<const SeamEdge> kept, const SlideLimits& limits,
                    const PatternOptions& pattern) {
  const TrialOptions trial = trial_options(pattern, limits.tolerance);
  std::vector<SeamEdge> all(kept.begin(), kept.end());
  all.insert(all.end(), seams.begin(), seams.end());
  const auto measured = [&](const TriMesh& mesh) {
    FlatMeasure whole;
    for (const CutTrial& of : measured_panels(panels_of({mesh, all}), trial)) whole.add(of.flat);
    return whole;
  };
  std::map<int, std::vector<SeamEdge>> slide;  // by number of the seam
  for (const SeamEdge& e : seams) slide[e.seam].push_back(e);

  TriMesh made = surface;
  FlatMeasure before = measured(made);
  const double least = std::min(before.within / before.area - kMostLost, limits.share);
  for (const auto& [seam, edges] : slide) {
    std::vector<SeamEdge> stay;
    std::copy_if(all.begin(), all.end(), std::back_inserter(stay),
                 [number = seam](const SeamEdge& e) { return e.seam != number; });
    TriMesh tried = fair_seams(made, edges, stay);
    const FlatMeasure after = measured(tried);
    if (after.within < least * after.area || (before.sound && !after.sound)) continue;
    made = std::move(tried);
    before = after;
  }
  return made;
}

}  // namespace geoprior::sketch
