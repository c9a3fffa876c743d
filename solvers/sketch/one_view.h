#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/depth_system.h"
#include "solvers/sketch/drawing/drawn_panels.h"
#include "solvers/sketch/drawing/mirror_plane.h"
#include "solvers/sketch/drawing/mirror_surface.h"
#include "solvers/sketch/hidden/hidden_borders.h"
#include "solvers/sketch/surface/refine_depth.h"
#include "solvers/sketch/surface/ruled_fill.h"
#include "solvers/sketch/surface/ruled_patches.h"
#include "solvers/sketch/surface/ruling_warp.h"

namespace geoprior::sketch {

/// Parameters of the reconstruction from one view.
struct OneViewOptions {
  CurveNetOptions curves;
  RulingWarpOptions rulings;
  DepthOptions depth;
  double vector_ratio = 1;
  double pair_tolerance = 0.03;
  bool mirror = true;
  /// Pixels by which photograph and drawing may disagree, where textures are read (`bake_pattern`).
  double disagreement = 2;
  bool fair = true;
  Completion complete = Completion::all;
  std::optional<RefineOptions> refine =
      RefineOptions{};  ///< non-linear, from the quadratic energy's minimum
};
void describe(OptionVisitor& v, OneViewOptions& options);

/// A patch of the surface.
struct OneViewPatch {
  std::string name;           ///< panel; of a ruled patch without one, its first drawn ruling
  bool ruled = false;         ///< swept by rulings; otherwise fair
  bool flat = false;          ///< its border was asked to be plane
  RuledStrip strip;           ///< of a ruled patch, before the surface is made symmetric
  Eigen::MatrixX2d unrolled;  ///< of the strip's vertices (m)
};

/// Reconstruction: x right, y up, z towards the eye, with z = 0 at the tail of sym-a (m).
struct OneViewResult {
  CompletedView completed;  ///< the drawing with whole borders, of which the net is made
  CurveNet net;
  MirrorPlanes planes;  ///< the one used, and the other reading of the same picture
  std::vector<RuledPatch> rulings;
  DepthSolution depth;  ///< nodes of the net in space; residuals; condition
  std::vector<OneViewPatch> patches;
  TexturedSurface surface;              ///< welded; symmetric when asked for
  double noise = 0;                     ///< of a drawn coordinate, as estimated (m)
  double disagreement = 2;              ///< of photograph and drawing (pixels)
  bool kept_positive = true;            ///< the half towards the eye was kept
  int matches = 0;                      ///< dense symmetric correspondences
  double guessed_area = 0;              ///< share of the surface, before it is made symmetric
  std::optional<RefinedDepth> refined;  ///< when asked for; `depth` and `planes.chosen` are its
};

/// Developable surface from one annotated view (thesis 2.1.3; Fondevilla et al. 2017).
///
/// 0. Trembling borders are faired (`faired_borders`). The noise that they had tells within what
///    ends meet (three deviations at least), and how little pairs weigh beside dense matches (5e-4
///    of the diagonal as good as exact). Hidden parts of borders are completed where only what is
///    visible is drawn (`complete_borders`).
/// 1. Borders become curves (`build_curve_net`); the mirror plane comes from its two vectors
///    (`mirror_plane.h`), dense symmetric correspondences from the pairs (`dense_matches`), rulings
///    from drawn ones by time warping (`sweep_ruled_patches`).
/// 2. Depth is the minimum of one quadratic energy (`solve_depth`); with `refine`, depth and mirror
///    plane are then improved together (`refine_depth`): with the drawn vectors' lengths held to
///    their ratio, as the linear system takes them, and, where `vector_ratio` of the refinement is
///    0, with the ratio free. The free one is kept when its cost is clearly less, and noise does
///    not explain its ratio (`spread_of_ratio`): in a flat view, where the ratio alone tells the
///    plane, both cost the same.
/// 3. Ruled patches become strips, other named panels fair patches; borders are shared, so that
///    patches are welded. With `mirror`, the half whose borders are more visible is kept (the one
///    towards the eye when both are within 2 %), and its mirror image joined along the plane.
///
/// Texture coordinates are places in the picture, 0 to 1 from its lower left corner (in the box
/// about the borders, when there is no picture).
///
/// The shape mirrored in depth has the same picture: `planes.other` is the plane of that reading,
/// chosen by marking sym-a "back".
///
/// It cannot know depth that no pair, ruling or plane leads to: that is refused, never guessed.
///
/// @param view    of kind photo
/// @throws Error  on anything that the steps refuse, with the ids of strokes
OneViewResult reconstruct_one_view(const View& view, const OneViewOptions& options);

/// A sentence each on what was guessed of hidden borders, on panels that are drawn narrower than
/// thirty deviations of the noise, whose sizes are then not sure, and on borders whose depth no
/// symmetry tells (`unpaired_borders`); none when there is nothing to say.
std::vector<std::string> one_view_notes(const View& view, const OneViewOptions& options);

}  // namespace geoprior::sketch
