#pragma once

#include <optional>

#include "core/frame.h"
#include "models/paper/sheet/sheet.h"

namespace geoprior::paper {

/// The obstacles of a sheet at one time as triangles to look at, with the cell array "obstacle"
/// (its index): planes as squares of two diameters of the pattern, endless cylinders as long ones.
/// A hollow sphere is the half that lies away from +x and -y, so that one sees into it. Absent when
/// the sheet has none.
std::optional<Part> obstacle_part(const Sheet& sheet, double time);

}  // namespace geoprior::paper
