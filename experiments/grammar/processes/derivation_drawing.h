#pragma once

#include <string>
#include <vector>

#include "core/frame.h"
#include "solvers/grammar/engine/derivation.h"

namespace geoprior::grammar {

/// Adds the array `touched` over the cells of the part `surface`: 0 of elements that were not
/// asked, 1 of those that were asked and stayed bit for bit, 2 of those that changed, 3 of new
/// ones.
void add_touched(const Transaction& transaction, Frame& frame);

/// A derivation as an SVG drawing: a box for each application of a rule, below the one that asked
/// for it; those of the phase up stand in a row on top, from the edited element on the right to the
/// one that bounds the locality on the left.
std::string derivation_svg(const Hierarchy& hierarchy, const DerivationReport& report);

/// The drawing and the text of `trace_text`, named by the number of the frame.
std::vector<Artifact> derivation_files(const Hierarchy& hierarchy, const DerivationReport& report,
                                       int frame);

}  // namespace geoprior::grammar
