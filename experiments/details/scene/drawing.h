#pragma once

#include <memory>

#include "core/frame.h"
#include "core/method.h"
#include "experiments/details/scene/scene.h"

namespace geoprior::details {

/// The surface of the frame's parts "surface" and "details" as the scene's `drawing` has it: with
/// spikes or meshes on it, or with holes in it. Point array "kind": 0 the surface, 1 details of the
/// scene, 2 details that were born since. The frame is left as it was.
Part drawn_surface(Frame& frame, const DetailsScene& scene);

/// The process with a part "drawn" in the frames that the scene's `drawing` chooses: its
/// `drawn_surface`. Without a `drawing` the process itself.
std::unique_ptr<Process> with_drawing(std::unique_ptr<Process> process, const DetailsScene& scene);

}  // namespace geoprior::details
