#include "baselines/torus/revolution.h"

#include "baselines/torus/shared/pointwise.h"
#include "models/torus/frames.h"
#include "models/torus/revolution.h"

namespace geoprior::torus {

void describe(OptionVisitor& /*v*/, RevolutionOptions& /*options*/) {}

std::unique_ptr<Process> make_revolution_torus(const TorusInput& input, const RevolutionOptions&) {
  return make_torus_process(input, [](const TorusInput& given, RunContext&) {
    return make_pointwise_map(
        [radii = given.radii](const Eigen::Vector2d& at) { return revolution_point(radii, at); });
  });
}

}  // namespace geoprior::torus
