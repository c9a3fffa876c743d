#pragma once

#include <memory>
#include <string>

#include "core/frame.h"
#include "core/method.h"
#include "core/options.h"
#include "experiments/details/drawing/detail_drawing.h"

namespace geoprior::details {

class DetailsScene;

/// `drawing`: details as geometry, in some of the recorded frames.
struct DetailDrawingOptions {
  int frames = 1;      ///< beside the first, evenly over the motion
  int pop_frames = 2;  ///< at which popping of the drawing is measured
  DrawingOptions look;
  std::string file;  ///< of the mesh that is put onto the surface: kind mesh, shape given
};
void describe(OptionVisitor& v, DetailDrawingOptions& options);

/// The surface of the frame's parts "surface" and "details" as the scene's `drawing` has it: with
/// spikes or meshes on it, or with holes in it. Point array "kind": 0 the surface, 1 details of the
/// scene, 2 details that were born since. The frame is left as it was.
Part drawn_surface(Frame& frame, const DetailsScene& scene);

/// The process with a part "drawn" in the frames that the scene's `drawing` chooses: its
/// `drawn_surface`. Without a `drawing` the process itself.
std::unique_ptr<Process> with_drawing(std::unique_ptr<Process> process, const DetailsScene& scene);

}  // namespace geoprior::details
