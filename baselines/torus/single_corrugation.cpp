#include "baselines/torus/single_corrugation.h"

#include <cmath>
#include <numbers>

#include "baselines/torus/shared/pointwise.h"
#include "models/torus/frames.h"
#include "models/torus/revolution.h"

namespace geoprior::torus {

void describe(OptionVisitor& v, SingleCorrugationOptions& options) {
  v.value("number", options.number, {.doc = "waves N around the tube", .min = 1, .max = 1000000});
  v.value("amplitude", options.amplitude,
          {.doc = "root mean square of the way from the torus of revolution, along its normal",
           .unit = "m",
           .min = 0,
           .max = 1});
}

std::unique_ptr<Process> make_single_corrugation(const TorusInput& input,
                                                 const SingleCorrugationOptions& options) {
  return make_torus_process(input, [options](const TorusInput& given, RunContext&) {
    return make_pointwise_map([radii = given.radii, options](const Eigen::Vector2d& at) {
      const double wave = std::cos(2 * std::numbers::pi * options.number * at.x());
      return Eigen::Vector3d(revolution_point(radii, at) + options.amplitude * std::numbers::sqrt2 *
                                                               wave * revolution_normal(at));
    });
  });
}

}  // namespace geoprior::torus
