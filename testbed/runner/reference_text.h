#pragma once

#include <array>
#include <string>
#include <string_view>

#include "testbed/runner/reference.h"

namespace geoprior {

constexpr std::string_view kReferenceFirstLine = "geoprior reference 3";

/// Of a metric of frames, in the order of a line's numbers.
constexpr std::array<std::string_view, 4> kReferenceStatistics{".min", ".median", ".max", ".last"};

/// A reference file as text (docs/file-formats.md): the same reference gives the same bytes.
/// @throws Error  when a metric has some of min, median, max and last only, or two units
std::string reference_text(const Reference& reference);

}  // namespace geoprior
