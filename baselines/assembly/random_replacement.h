#pragma once

#include <memory>

#include "core/random.h"
#include "models/assembly/exchange/matching_options.h"
#include "models/assembly/exchange/replacement.h"

namespace geoprior::assembly {

struct RandomReplacementOptions {
  MatchingOptions match;
  int attempts = 2000;
};
void describe(OptionVisitor& v, RandomReplacementOptions& options);

/// Random replacement with rejection: connected parts of host and donor grow from a random part to
/// a random size, neighbour by random neighbour, and a random bijection of their boundaries is
/// tried.
std::unique_ptr<ReplacementFinder> make_random_replacement(const DonorSet& donors,
                                                           const RandomReplacementOptions& options,
                                                           const RandomStream& random);

}  // namespace geoprior::assembly
