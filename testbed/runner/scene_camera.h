#pragma once

#include <string>

#include "core/options.h"
#include "testbed/figure_view.h"
#include "testbed/runner/journal/run_record.h"

namespace geoprior {

void describe(OptionVisitor& v, Camera& camera);

/// A camera as keys of [figure_view], to be recorded or pasted into an experiment file.
std::string camera_text(const Camera& camera);

/// The view of a run: where it leaves the camera free, with that which the scene of the first drawn
/// case suggests.
/// @param file  of the run, for messages
/// @throws Error  when the recorded camera is none
FigureView with_scene_camera(FigureView view, const RunRecord& record, const std::string& file);

}  // namespace geoprior
