#pragma once

#include <optional>
#include <string>

#include "core/frame.h"
#include "core/state_bytes.h"

namespace geoprior {

/// A part and its parameter as bytes of this machine, bit by bit.
State part_to_bytes(const Part& part, std::optional<double> parameter);

/// Reads them back. The bytes may be anything: what is returned has indices of its points, sizes of
/// its grid, rows of its arrays and names of their values that fit together.
/// @throws Error  naming `where` and what does not fit
Part part_from_bytes(const State& bytes, std::optional<double>& parameter,
                     const std::string& where);

}  // namespace geoprior
