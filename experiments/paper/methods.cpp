#include "baselines/paper/adaptive.h"
#include "baselines/paper/dense.h"
#include "experiments/paper/scene.h"
#include "experiments/paper/topic.h"
#include "solvers/paper/hybrid.h"

namespace geoprior {

std::vector<MethodEntry> paper_methods() {
  using S = PaperScene;
  return {
      method_entry<S, DenseOptions>("dense", true, "shell elements on one uniform mesh",
                                    "implicit Euler: Baraff and Witkin 1998; docs/methods/paper.md",
                                    [](const S& scene, const DenseOptions& options, RunContext&) {
                                      return make_dense_sheet(scene.sheet, options);
                                    }),
      method_entry<S, AdaptiveOptions>(
          "adaptive", true, "shell elements, anisotropic remeshing in the pattern",
          "Narain, Samii and O'Brien 2012; Narain, Pfaff and O'Brien 2013",
          [](const S& scene, const AdaptiveOptions& options, RunContext&) {
            return make_adaptive_sheet(scene.sheet, options);
          }),
      method_entry<S, HybridOptions>(
          "hybrid", false, "planes, cylinders and cones decide the mesh of a coarse elastic sheet",
          "thesis 3.2.1; Schreck et al. 2015",
          [](const S& scene, const HybridOptions& options, RunContext&) {
            return make_hybrid_sheet(scene.sheet, options);
          }),
  };
}

}  // namespace geoprior
