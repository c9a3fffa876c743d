#pragma once

#include <filesystem>
#include <vector>

#include "testbed/figure_view.h"
#include "testbed/runner/opened_run.h"

namespace geoprior {

/// Draws spectrogram.png of a run whose drawn variants have a sound, by results/spectrogram.py: of
/// each variant six frames (where frames are at times), its events and the levels of its sound,
/// over one time axis. Of the view's cases with a sound the first is spectrogram.png, each further
/// one spectrogram-<case>.png. Needs no display, as render_run.
/// @return  the pictures; none where nothing has a sound
/// @throws Error  naming what is missing, as render_run and run_python
std::vector<std::filesystem::path> draw_spectrograms(const OpenedRun& run, const FigureView& view);

}  // namespace geoprior
