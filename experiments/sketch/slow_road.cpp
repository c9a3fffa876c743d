#include "experiments/sketch/slow_road.h"

#include <memory>

#include "baselines/sketch/visual_hull/exact_hull.h"
#include "experiments/sketch/flattened.h"
#include "experiments/sketch/scene/scene.h"

namespace geoprior::sketch {
namespace {

struct SlowRoadOptions {
  ComparedSurface surface;
};
void describe(OptionVisitor& v, SlowRoadOptions& o) {
  describe_group(v, "surface", o.surface, {.doc = "how the surface is made from the exact hull"});
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

MethodEntry slow_road_method() {
  MethodEntry method = method_entry<SketchScene, SlowRoadOptions>(
      "slow-road", true,
      "as several-views on a hull by exact Booleans and isotropic remeshing, laid flat by "
      "CGAL's as-rigid-as-possible",
      "CGAL 5.5, Polygon Mesh Processing and Surface Mesh Parameterization",
      [](const SketchScene& scene, const SlowRoadOptions& options, RunContext&) {
        return slow_road_process(scene, options);
      });
  method.ungated =
      "CGAL's corefinement numbers what it makes by addresses, so that its remeshing does not "
      "repeat";
  return method;
}

}  // namespace geoprior::sketch
