#include "experiments/sketch/flattened.h"

#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "baselines/sketch/flatten/abf.h"
#include "baselines/sketch/flatten/cgal_flatten.h"
#include "baselines/sketch/flatten/lscm.h"
#include "baselines/sketch/visual_hull/visual_hull.h"
#include "core/error.h"
#include "experiments/sketch/scene/scene.h"

namespace geoprior::sketch {
namespace {

constexpr std::array<std::string_view, 5> kFlattenings{"rigid", "lscm", "abf", "cgal-arap",
                                                       "cgal-lscm"};

/// CGAL mends what its as-rigid-as-possible turns over by a pass that refuses some borders (those
/// of remeshed pieces that are folded over a part of the border); a road that ends there is no
/// comparison.
Eigen::MatrixX2d cgal_arap_or_lscm(const TriMesh& disc) {
  try {
    return flatten_cgal_arap(disc);
  } catch (const Error&) {
    return flatten_cgal_lscm(disc);
  }
}

struct FlattenedOptions {
  FlattenBy by = FlattenBy::rigid;
  ComparedSurface surface;
};
void describe(OptionVisitor& v, FlattenedOptions& o) {
  describe_choice(v, "by", o.by, kFlattenings,
                  {.doc = "how a piece is laid flat: our as-rigid-as-possible, least squares "
                          "conformal, ABF++, or CGAL's two"});
  describe_group(v, "surface", o.surface, {.doc = "how the surface of a drawing is made"});
}

std::unique_ptr<Process> flattened_process(const SketchScene& scene,
                                           const FlattenedOptions& options) {
  const SketchInput input = with_flattening(scene.input, options.by);
  // A surface that is given is laid flat as it is.
  return input.surface ? make_visual_hull_process(input, {})
                       : make_several_views_process(input, options.surface.options());
}

}  // namespace

SketchInput with_flattening(SketchInput input, FlattenBy by) {
  input.patterns = true;
  input.pattern.hole_tolerance_deg = 0;
  switch (by) {
    case FlattenBy::rigid:
      break;
    case FlattenBy::lscm:
      input.pattern.lay_disc = [](const TriMesh& disc) { return flatten_lscm(disc); };
      break;
    case FlattenBy::abf:
      input.pattern.lay_disc = [](const TriMesh& disc) { return flatten_abf(disc); };
      break;
    case FlattenBy::cgal_arap:
      input.pattern.lay_disc = cgal_arap_or_lscm;
      break;
    case FlattenBy::cgal_lscm:
      input.pattern.lay_disc = [](const TriMesh& disc) { return flatten_cgal_lscm(disc); };
      break;
  }
  return input;
}

SeveralViewsOptions ComparedSurface::options() const {
  SeveralViewsOptions all;
  all.iterations = iterations;
  return all;
}

void describe(OptionVisitor& v, ComparedSurface& o) {
  v.value("iterations", o.iterations,
          {.doc = "iterations of several-views by which the surface is made; a frame each",
           .min = 1,
           .max = 1000});
}

MethodEntry flattened_method() {
  return method_entry<SketchScene, FlattenedOptions>(
      "flattened", true, "the same surface as several-views, laid flat in a way of choice",
      "Levy et al. 2002; Sheffer et al. 2005; Liu et al. 2008",
      [](const SketchScene& scene, const FlattenedOptions& options, RunContext&) {
        return flattened_process(scene, options);
      });
}

}  // namespace geoprior::sketch
