#pragma once

#include <string>
#include <string_view>

#include "testbed/runner/reference/blessed.h"

namespace geoprior {

constexpr std::string_view kReferenceFirstLine = "geoprior reference 5";
/// In the place of a row's cases: all that the set has.
constexpr std::string_view kAllCases = "*";
/// Between the cases of a row; no name of a case has it.
constexpr char kBetweenCases = '|';

/// A reference file as text (docs/file-formats.md): the same reference gives the same bytes.
/// @throws Error  when a metric has two units
std::string reference_text(const Reference& reference);

}  // namespace geoprior
