#pragma once

#include <memory>

#include "models/assembly/exchange/matching_options.h"
#include "models/assembly/exchange/replacement.h"

namespace geoprior::assembly {

struct GrowthOptions {
  MatchingOptions match;
};
void describe(OptionVisitor& v, GrowthOptions& options);

/// What the thesis describes: two substructures grow at once from a pair of seeds on the two dual
/// graphs, in the order of the ports around each part.
///
/// A seed is a connection, read from one of its ends, of the same type in host and donor. Both
/// sides begin with the part that the connection leads to. Their boundaries are listed as they were
/// met, the ports of a part in order from the one it was reached by. Where the lists agree place by
/// place the two can replace each other; where they first differ both take in the part that is
/// there, or the one that still has a place; after a match, the parts at the first place after the
/// seed. The search from a seed ends when a side has no more, is too large, or takes in the part
/// before its seed.
///
/// What it cannot do: it takes one way of many at each step, so that most substructures are never
/// met; nothing is said of how many.
/// Source: thesis 2.2.3, in the order that is said there; its details are ours.
std::unique_ptr<ReplacementFinder> make_growth(const DonorSet& donors,
                                               const GrowthOptions& options);

}  // namespace geoprior::assembly
