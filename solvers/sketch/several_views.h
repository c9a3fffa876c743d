#pragma once

#include <memory>
#include <vector>

#include "core/options.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/developable_rotation.h"
#include "solvers/sketch/fold_rotation.h"
#include "solvers/sketch/zippering.h"

namespace geoprior::sketch {

/// How the two steps of an iteration follow each other.
enum class StepOrder {
  merged,       ///< one solve: triangles turned, silhouettes pinned
  alternating,  ///< silhouettes first, with triangles as they are; then triangles turned
};

struct SeveralViewsOptions {
  int iterations = 10;
  StepOrder order = StepOrder::merged;
  DevelopableRotationOptions developability;
  FoldOptions fold;
  bool silhouettes = true;  ///< false: developability alone
  SilhouetteChoice silhouette = SilhouetteChoice::protruding;
  bool folds = true;      ///< false: drawn folds ask for nothing
  bool pin_seams = true;  ///< seams stay where they were drawn, in their view
};
void describe(OptionVisitor& v, SeveralViewsOptions& options);

/// Developable surface from several views (thesis 2.1.2; Jung, Hahmann, Rohmer, Begault, Boissieux
/// and Cani 2015): the smoothed visual hull is pulled onto the drawn silhouettes and made
/// developable, in turns.
///
/// Every iteration closes the silhouettes (`Zippering`), turns the triangles towards cones
/// (`DevelopableRotation`) and folds (`FoldRotation`), and solves for the surface
/// (`PinnedTransfer`) with the chosen edges where the hull has them in their view: silhouettes are
/// met exactly, but for gaps that are reported. Borders and seams stay on their strokes likewise,
/// free to slide along them.
///
/// It cannot: find seams by itself, treat parts that hide each other, make folds that no view
/// shows.
std::unique_ptr<Process> make_several_views_process(const SketchInput& input,
                                                    const SeveralViewsOptions& options);

/// The method of that process.
std::unique_ptr<SketchMethod> make_several_views(const PreparedSketch& prepared,
                                                 const SeveralViewsOptions& options);

}  // namespace geoprior::sketch
