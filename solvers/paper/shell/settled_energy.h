#pragma once

#include <cstdint>

#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"
#include "models/paper/shell/stepper.h"

namespace geoprior::paper {

/// Elastic energy (J) that a sheet has on its mesh once it has settled: after a few implicit steps
/// from rest with the handles where they are, without plastic flow. Infinite when it cannot settle.
///
/// What tells apart two structures for one sheet: right after a mesh is made, both hold strain that
/// the first steps release.
double settled_energy(const Sheet& sheet, const StepperOptions& options, std::uint64_t seed,
                      ShellState state);

}  // namespace geoprior::paper
