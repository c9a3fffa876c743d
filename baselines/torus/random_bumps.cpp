#include "baselines/torus/random_bumps.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "baselines/torus/shared/pointwise.h"
#include "models/torus/frames.h"
#include "models/torus/revolution.h"

namespace geoprior::torus {
namespace {

/// cos(2 pi (number . x + phase)).
struct BumpWave {
  Eigen::Vector2d number;
  double phase = 0;
};

std::vector<BumpWave> draw_waves(const RandomBumpsOptions& options, RandomStream random) {
  std::vector<BumpWave> waves(options.waves);
  for (BumpWave& wave : waves) {
    do {
      for (int k = 0; k < 2; ++k)
        wave.number(k) =
            static_cast<double>(random.below(2 * options.highest + 1)) - options.highest;
    } while (wave.number.isZero() || wave.number.norm() > options.highest);
    wave.phase = random.uniform();
  }
  return waves;
}

}  // namespace

void describe(OptionVisitor& v, RandomBumpsOptions& options) {
  v.value("waves", options.waves, {.doc = "waves that are added up", .min = 1, .max = 10000});
  v.value("highest", options.highest,
          {.doc = "most periods of a wave along a side of the square", .min = 1, .max = 1000000});
  v.value("amplitude", options.amplitude,
          {.doc = "root mean square of the way from the torus of revolution, along its normal",
           .unit = "m",
           .min = 0,
           .max = 1});
}

std::unique_ptr<Process> make_random_bumps(const TorusInput& input,
                                           const RandomBumpsOptions& options) {
  return make_torus_process(input, [options](const TorusInput& given, RunContext& context) {
    const double scale = options.amplitude * std::sqrt(2. / options.waves);
    return make_pointwise_map([radii = given.radii, scale,
                               waves = draw_waves(options, context.random("bumps"))](
                                  const Eigen::Vector2d& at) {
      double height = 0;
      for (const BumpWave& wave : waves)
        height += std::cos(2 * std::numbers::pi * (wave.number.dot(at) + wave.phase));
      return Eigen::Vector3d(revolution_point(radii, at) + scale * height * revolution_normal(at));
    });
  });
}

}  // namespace geoprior::torus
