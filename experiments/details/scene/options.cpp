#include "experiments/details/scene/options.h"

#include "core/limits.h"

namespace geoprior::details {

void describe(OptionVisitor& v, DetailMotionOptions& options) {
  v.value("frames", options.frames,
          {.doc = "frames after the first, which is the surface at rest",
           .min = 1,
           .max = kMostFrames});
  v.value("duration", options.duration,
          {.doc = "time from the first frame to the last", .unit = "s", .min = 1e-9});
  describe_list(v, "deform", options.deform,
                {.doc = "deformations of the surface, one after the other"});
  describe_group(v, "drag", options.drag,
                 {.doc = "handles that are dragged before `deform`, the surface following as "
                         "rigidly as possible"});
  describe_group(v, "sequence", options.sequence,
                 {.doc = "meshes on disk with the same triangles in every frame, instead of "
                         "`deform` and `drag`"});
}

void describe(OptionVisitor& v, DetailSceneOptions& options) {
  describe_group(v, "surface", options.surface, {.doc = "smooth surface at rest"});
  describe_group(v, "pattern", options.pattern, {.doc = "details on the surface at rest"});
  describe_group(v, "motion", options.motion, {.doc = "motion of the surface"});
  v.value(
      "detail_height", options.detail_height,
      {.doc = "height of a detail of weight 1, for popping; absent: half of the mean edge of M_d",
       .unit = "m",
       .min = 1e-9});
  v.value("pair_frames", options.pair_frames,
          {.doc = "frames, evenly over the motion, at which the pair correlation is measured",
           .min = 1,
           .max = kMostFrames});
  v.value("pair_sources", options.pair_sources,
          {.doc = "details, evenly spread, from which the pair correlation measures distances",
           .min = 2});
  describe_group(v, "drawing", options.drawing,
                 {.doc = "geometry of the details in some frames; absent: in none"});
}

}  // namespace geoprior::details
