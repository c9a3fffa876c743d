#include "experiments/paper/scene/options.h"

namespace geoprior::paper {

void describe(OptionVisitor& v, PlacementOptions& options) {
  v.value("move", options.move, {.doc = "place of the pattern's origin in space", .unit = "m"});
  v.value("turn_deg", options.turn_deg,
          {.doc = "turn of the sheet about the pattern's origin, axis times angle", .unit = "deg"});
}

void describe(OptionVisitor& v, PaperSceneOptions& options) {
  describe_group(v, "pattern", options.pattern, {.doc = "flat shape that is cut out of the paper"});
  describe_group(v, "material", options.material,
                 {.doc = "what the sheet is made of; default: office paper, 80 g/m^2"});
  describe_group(v, "toughness", options.toughness, {.doc = "what the paper opposes to tearing"});
  describe_list(v, "handles", options.handles, {.doc = "where the sheet is held or pulled"});
  describe_list(v, "obstacles", options.obstacles, {.doc = "bodies that the sheet does not enter"});
  constexpr double kFastestFall = 1e6;  // at the surface of a white dwarf
  v.value("gravity", options.gravity,
          {.doc = "acceleration of free fall",
           .unit = "m/s^2",
           .min = -kFastestFall,
           .max = kFastestFall});
  describe_group(
      v, "placement", options.placement,
      {.doc = "where the pattern (u, v, 0) is in space at the start; default: as it is"});
  v.value(
      "imperfection", options.imperfection,
      {.doc = "height of the seeded waves of the flat start", .unit = "m", .min = 0, .max = 1e6});
  v.value("duration", options.duration,
          {.doc = "simulated time", .unit = "s", .min = 1e-9, .max = 1e6});
  v.value("frame_interval", options.frame_interval,
          {.doc = "time between recorded frames", .unit = "s", .min = 1e-9, .max = 1e6});
  v.value("substeps", options.substeps,
          {.doc = "least number of time steps of a frame", .min = 1, .max = 100000});
  v.value("handle_step", options.handle_step,
          {.doc = "farthest that a handle goes in a step: frames in which one is faster have more "
                  "steps (up to 1000), on every mesh",
           .unit = "m",
           .min = 1e-7,
           .max = 1e6});
  v.value("fold_radius", options.fold_radius,
          {.doc = "radius of the discs of the pattern within which folds of opposite sign cancel "
                  "(cancelling_share)",
           .unit = "m",
           .min = 1e-4,
           .max = 100});
}

}  // namespace geoprior::paper
