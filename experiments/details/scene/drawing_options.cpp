#include "experiments/details/scene/drawing_options.h"

#include "core/limits.h"

namespace geoprior::details {

void describe(OptionVisitor& v, DetailDrawingOptions& options) {
  v.value("frames", options.frames,
          {.doc = "frames that are drawn beside the first, evenly over the motion",
           .min = 1,
           .max = kMostFrames});
  v.value("pop_frames", options.pop_frames,
          {.doc = "frames, evenly over the motion, at which popping of the drawing since the frame "
                  "before is measured",
           .min = 1,
           .max = kMostFrames});
  describe_group(v, "look", options.look, {.doc = "what a detail is drawn as"});
  const bool given =
      options.look.kind == DrawnKind::mesh && options.look.instance.shape == InstanceShape::given;
  if (given) {
    v.value("file", options.file,
            {.doc = "mesh of a detail (z its normal): .obj, .ply, .off, .stl, .vtp, .pvtp",
             .required = true,
             .named = Named::file});
  }
}

}  // namespace geoprior::details
