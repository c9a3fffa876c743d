#pragma once

#include <memory>

#include "models/assembly/exchange/matching_options.h"
#include "models/assembly/exchange/replacement.h"

namespace geoprior::assembly {

struct SingleExchangeOptions {
  int boundary = 4;
  bool symmetries = true;
  Matching matching = Matching::observed;
};
void describe(OptionVisitor& v, SingleExchangeOptions& options);

/// One part gives way to one part: the interchangeable components that replaceable substructures
/// extend (thesis 2.2.3).
/// Source: Kreavoy, Julius and Sheffer 2007, "Model composition from interchangeable components".
std::unique_ptr<ReplacementFinder> make_single_exchange(const DonorSet& donors,
                                                        const SingleExchangeOptions& options);

}  // namespace geoprior::assembly
