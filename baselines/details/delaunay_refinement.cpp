#include "baselines/details/delaunay_refinement.h"

namespace geoprior::details {
std::unique_ptr<DetailMethod> make_delaunay_refinement(const DetailScene& scene,
                                                       const DelaunayRefinementOptions& options) {
  require_valid(scene);
  return std::make_unique<DensityMethod>(scene, options);
}

std::unique_ptr<Process> make_delaunay_refinement_process(
    const DetailScene& scene, const DelaunayRefinementOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext&) {
    return make_delaunay_refinement(s, options);
  });
}

}  // namespace geoprior::details
