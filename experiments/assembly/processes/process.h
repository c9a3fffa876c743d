#pragma once

#include <memory>

#include "models/assembly/search/search.h"

namespace geoprior::assembly {

/// The process of a method that finds replacements: variations of the inputs, or a survey of them
/// where the input asks for one.
std::unique_ptr<Process> replacement_process(const AssemblyInput& input, FinderFactory factory,
                                             bool symmetries, const SearchOptions& options);

}  // namespace geoprior::assembly
