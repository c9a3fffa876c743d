#pragma once

#include "models/paper/sheet.h"

namespace geoprior::paper {

/// Greatest speed (m/s) of an anchor of a handle that holds the sheet between two times, from the
/// chords of `parts` equal parts of that time. Without such a handle 0.
/// @param parts  >= 1
double handle_speed(const Sheet& sheet, double start, double end, int parts);

/// Time steps of the frame from `start` to `end`: `sheet.substeps`, and as many more as keep every
/// handle within `sheet.handle_step` a step.
int substeps_of_frame(const Sheet& sheet, double start, double end);

}  // namespace geoprior::paper
