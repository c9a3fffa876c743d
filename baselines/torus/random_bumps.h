#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "models/torus/input.h"

namespace geoprior::torus {

struct RandomBumpsOptions {
  int waves = 64;
  int highest = 200;
  double amplitude = 0.01;
};
void describe(OptionVisitor& v, RandomBumpsOptions& options);

/// A random bump map along the normal of the torus of revolution: waves of random direction, number
/// and phase that close around the torus, of equal amplitude. It has the roughness of corrugations
/// and none of their geometry.
///
/// The waves are drawn from the seed of the run.
std::unique_ptr<Process> make_random_bumps(const TorusInput& input,
                                           const RandomBumpsOptions& options);

}  // namespace geoprior::torus
