#pragma once

#include <memory>

#include "core/options.h"
#include "models/assembly/exchange/matching_options.h"
#include "models/assembly/exchange/replacement.h"
#include "solvers/assembly/substructures.h"

namespace geoprior::assembly {

struct ExactOptions {
  MatchingOptions match;
  bool unions = true;
};
void describe(OptionVisitor& v, ExactOptions& options);

/// Replaceable substructures, every one of them (thesis 2.2.3, whose search is not exhaustive).
///
/// All connected substructures with a boundary of at most K connections are listed from the cuts of
/// the graph (substructures.h). One can replace another when some bijection of their boundaries
/// joins, at each, ports that some model joins (the thesis' consistency), or ports of the very
/// types that were joined there (`strict`). Substructures of the donors are filed by the port
/// classes of their inside ends, so that those which match are looked up, not searched.
///
/// What it cannot do: boundaries of more than four connections; a replacement of several
/// substructures at once is one of single ones, one after the other, each valid.
///
/// @param keep_alike  false: of donors' substructures that are isomorphic, boundary included, one
/// Source: thesis 2.2.3; Liu, Vimont, Wand, Cani, Hahmann, Rohmer and Mitra 2015.
std::unique_ptr<ReplacementFinder> make_exact_finder(const DonorSet& donors,
                                                     const ExactOptions& options, bool keep_alike);

}  // namespace geoprior::assembly
