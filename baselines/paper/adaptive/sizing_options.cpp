#include "baselines/paper/adaptive/sizing_options.h"

namespace geoprior::paper {

void describe(OptionVisitor& v, SizingOptions& options) {
  v.value("size_min", options.size_min,
          {.doc = "smallest edge length asked for", .unit = "m", .min = 1e-5, .max = 10});
  v.value("size_max", options.size_max,
          {.doc = "largest edge length asked for", .unit = "m", .min = 1e-5, .max = 10});
  v.value(
      "refine_angle", options.refine_angle,
      {.doc = "largest change of the normal along an edge", .unit = "rad", .min = 1e-3, .max = 10});
  v.value("refine_compression", options.refine_compression,
          {.doc = "largest edge length times the root of the compressive strain along the edge",
           .unit = "m",
           .min = 1e-7,
           .max = 1e3});
  v.value("refine_velocity", options.refine_velocity,
          {.doc = "largest difference of velocity along an edge",
           .unit = "m/s",
           .min = 1e-3,
           .max = 1e6});
  v.value("aspect_min", options.aspect_min,
          {.doc = "smallest ratio of the two sizes that are asked for at a vertex",
           .min = 0.01,
           .max = 1});
}

}  // namespace geoprior::paper
