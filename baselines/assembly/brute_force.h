#pragma once

#include <memory>

#include "models/assembly/exchange/matching_options.h"
#include "models/assembly/exchange/replacement.h"

namespace geoprior::assembly {

struct BruteForceOptions {
  MatchingOptions match;
};
void describe(OptionVisitor& v, BruteForceOptions& options);

/// The oracle: every connected set of parts, one part after the other taken in or left out, until
/// more than K connections lead to parts that were left out. No cuts, no signatures: two
/// substructures are compared by trying all bijections of their boundaries, and a new connection by
/// looking for one like it in the models, part by part through the symmetries.
///
/// What it cannot do: its work grows with n^(K+1), its comparisons with the square of what it
/// finds: models of more than 40 parts are refused.
/// @throws Error  on them, when it is asked
std::unique_ptr<ReplacementFinder> make_brute_force(const DonorSet& donors,
                                                    const BruteForceOptions& options);

/// Most parts of a model.
inline constexpr int kMostBruteForceParts = 40;

}  // namespace geoprior::assembly
