#pragma once

#include "testbed/figure_view.h"
#include "testbed/runner/opened_run.h"

namespace geoprior {

/// Draws spectrogram.png of a run whose drawn variants have a sound, by results/spectrogram.py: of
/// each variant six frames (where frames are at times), its events and the levels of its sound,
/// over one time axis. Needs no display, as render_run.
/// @return  whether there is a sound; without one nothing is drawn
/// @throws Error  naming what is missing, as render_run and run_python
bool draw_spectrogram(const OpenedRun& run, const FigureView& view);

}  // namespace geoprior
