#include "experiments/sketch/compared_methods.h"

#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "baselines/sketch/flatten/abf.h"
#include "baselines/sketch/flatten/cgal_flatten.h"
#include "baselines/sketch/flatten/lscm.h"
#include "baselines/sketch/visual_hull/exact_hull.h"
#include "baselines/sketch/visual_hull/visual_hull.h"
#include "core/error.h"
#include "experiments/sketch/scene/scene.h"
#include "solvers/sketch/several_views.h"

namespace geoprior::sketch {
namespace {

/// How a piece is laid flat.
enum class FlattenBy { rigid, lscm, abf, cgal_arap, cgal_lscm };

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

/// The input with that flattening. All but ours need discs, so that pieces with holes are cut open
/// for all of them.
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

/// The surface is that of several-views with its defaults; only how long it goes on is asked.
struct ComparedSurface {
  int iterations = SeveralViewsOptions{}.iterations;

  [[nodiscard]] SeveralViewsOptions options() const {
    SeveralViewsOptions all;
    all.iterations = iterations;
    return all;
  }
};
void describe(OptionVisitor& v, ComparedSurface& o) {
  v.value("iterations", o.iterations,
          {.doc = "Iterations of several-views by which the surface is made; a frame each.",
           .min = 1,
           .max = 1000});
}

struct FlattenedOptions {
  FlattenBy by = FlattenBy::rigid;
  ComparedSurface surface;
};
void describe(OptionVisitor& v, FlattenedOptions& o) {
  describe_choice(v, "by", o.by, kFlattenings,
                  {.doc = "How a piece is laid flat: our as-rigid-as-possible, least squares "
                          "conformal, angle-based (ABF++), or CGAL's two."});
  describe_group(v, "surface", o.surface, {.doc = "How the surface of a drawing is made."});
}

struct SlowRoadOptions {
  ComparedSurface surface;
};
void describe(OptionVisitor& v, SlowRoadOptions& o) {
  describe_group(v, "surface", o.surface, {.doc = "How the surface is made from the exact hull."});
}

std::unique_ptr<Process> flattened_process(const SketchScene& scene,
                                           const FlattenedOptions& options) {
  const SketchInput input = with_flattening(scene.input, options.by);
  // A surface that is given is laid flat as it is.
  return input.surface ? make_hull_process(input, {})
                       : make_several_views_process(input, options.surface.options());
}

std::unique_ptr<Process> slow_road_process(const SketchScene& scene,
                                           const SlowRoadOptions& options) {
  SketchInput input = with_flattening(scene.input, FlattenBy::cgal_arap);
  input.make_hull = [asked = input.hull](const Drawing& aligned) {
    return exact_hull(aligned, asked);
  };
  return make_several_views_process(input, options.surface.options());
}

}  // namespace

std::vector<MethodEntry> compared_methods() {
  std::vector<MethodEntry> methods{
      method_entry<SketchScene, FlattenedOptions>(
          "flattened", true, "the same surface as several-views, laid flat in a way of choice",
          "Levy et al. 2002; Sheffer et al. 2005; Liu et al. 2008",
          [](const SketchScene& scene, const FlattenedOptions& options, RunContext&) {
            return flattened_process(scene, options);
          }),
      method_entry<SketchScene, SlowRoadOptions>(
          "slow-road", true,
          "as several-views on a hull by exact Booleans and isotropic remeshing, laid flat by "
          "CGAL's as-rigid-as-possible",
          "CGAL 5.5, Polygon Mesh Processing and Surface Mesh Parameterization",
          [](const SketchScene& scene, const SlowRoadOptions& options, RunContext&) {
            return slow_road_process(scene, options);
          }),
  };
  methods.back().ungated =
      "CGAL's corefinement numbers what it makes by addresses, so that its remeshing does not "
      "repeat";
  return methods;
}

}  // namespace geoprior::sketch
