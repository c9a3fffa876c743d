#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/options.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/pattern/seam_suggestion.h"
#include "solvers/sketch/surface/developable_rotation.h"
#include "solvers/sketch/surface/fold_rotation.h"
#include "solvers/sketch/surface/ruling_average.h"
#include "solvers/sketch/surface/zippering.h"

namespace geoprior::sketch {

/// How the two steps of an iteration follow each other.
enum class StepOrder {
  merged,       ///< one solve: triangles turned, silhouettes pinned
  alternating,  ///< silhouettes first, with triangles as they are; then triangles turned
};

/// Seams and darts that are suggested for the surface of the last step.
struct SuggestedSeamsOptions {
  SeamSuggestionOptions find;
  int apply = 0;
  int iterations = 5;
};
void describe(OptionVisitor& v, SuggestedSeamsOptions& options);

struct SeveralViewsOptions {
  int iterations = 10;
  StepOrder order = StepOrder::merged;
  RulingAverageOptions fairing;
  DevelopableRotationOptions developability;
  FoldOptions fold;
  bool silhouettes = true;  ///< false: developability alone
  SilhouetteChoice silhouette = SilhouetteChoice::protruding;
  bool folds = true;  ///< false: drawn folds ask for nothing
  bool pin_seams = true;
  bool across_seams = true;
  bool drawn_seams = true;  ///< false: seams of the drawing are left out
  std::optional<SuggestedSeamsOptions> suggest = {};
};
void describe(OptionVisitor& v, SeveralViewsOptions& options);

/// Developable surface from several views (thesis 2.1.2; Jung, Hahmann, Rohmer, Begault, Boissieux
/// and Cani 2015): the smoothed visual hull is pulled onto the drawn silhouettes and made
/// developable, in turns.
///
/// Every iteration closes the silhouettes (`Zippering`), turns the triangles, and solves for the
/// surface (`PinnedTransfer`) with the chosen edges where the hull has them in their view:
/// silhouettes are met exactly, but for gaps that are reported. Borders and seams stay on their
/// strokes likewise, free to slide along them. Triangles are turned to fair rulings
/// (`RulingAverage`, which does not look across seams) in the first half of the iterations, towards
/// cones of their neighbourhood
/// (`DevelopableRotation`) in the second, and in all of them towards drawn folds (`FoldRotation`).
/// The cones alone, as the thesis has them, leave a saw along every former edge of the hull.
///
/// It cannot: move the seams that it is given, treat parts that hide each other, make folds that no
/// view shows.
/// @param suggestion_files  what is made of the suggestions; see SeamSuggester
std::unique_ptr<Process> make_several_views_process(
    const SketchInput& input, const SeveralViewsOptions& options,
    std::function<std::vector<Artifact>(const std::vector<SuggestedSeam>&)> suggestion_files = {});

/// The method of that process.
std::unique_ptr<SketchMethod> make_several_views(const PreparedSketch& prepared,
                                                 const SeveralViewsOptions& options);

}  // namespace geoprior::sketch
