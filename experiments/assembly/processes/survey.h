#pragma once

#include <memory>

#include "core/method.h"
#include "models/assembly/search/search.h"

namespace geoprior::assembly {

/// What a finder finds in each model of an input: a frame a model.
///
/// Parts as of any assembly, the model's own, or its first closing replacement where there is one.
/// Tables: `substructures`, a row each with boundary, parts, the set as words of 48 bits, and where
/// the survey asks for pairs how many replacements it has and a sum of their sets that does not
/// depend on their order; `residuals`, how many replacements of which one piece holds two seams or
/// more have a gap between two bounds, and how many of these close (those that change nothing are
/// left out); `outputs`, a row for each distinct assembly of a consistent replacement, closing or
/// not: four words of its canonical key.
std::unique_ptr<Process> survey_process(const AssemblyInput& input, FinderFactory factory,
                                        bool symmetries, const SearchOptions& options);

}  // namespace geoprior::assembly
