#pragma once

#include "testbed/figure_view.h"
#include "testbed/runner/opened_run.h"

namespace geoprior {

/// Draws figure.png of a run: variants side by side, one camera, one colour range, labels, scalar
/// bar with unit; and contact-sheet.png where the view asks for one. Needs no display: starts a
/// virtual X server of its own when there is none. Throws Error naming what is missing.
void render_run(const OpenedRun& run, const FigureView& view);

}  // namespace geoprior
