#include "experiments/torus/scene/options.h"

namespace geoprior::torus {

void describe(OptionVisitor& v, CorrugationOptions& options) {
  v.value("direction", options.direction,
          {.doc = "direction i of the corrugation: covectors (-1, 0), (-1, -2), (-1, 2)",
           .min = 0,
           .max = 2});
  v.value("number", options.number,
          {.doc = "number N of the corrugation; absent: the smallest that leaves each coefficient "
                  "of the next corrugations at least `scene.margin` of what it would be without "
                  "this one's error",
           .min = 1,
           .max = 1e9});
  v.value("share", options.share,
          {.doc = "share d_k of the way to the metric of the square that the stage goes which "
                  "begins here; absent: the stage goes on, and the first one has d_0 = 4 (r2^2 - "
                  "r1^2) / (3 + r2^2 - 3 r1^2)",
           .min = 1e-6,
           .max = 1});
}

void describe(OptionVisitor& v, ViewOptions& options) {
  v.value("x", options.x,
          {.doc = "x of the centre of the square that frames show", .min = 0, .max = 1});
  v.value("y", options.y,
          {.doc = "y of the centre of the square that frames show", .min = 0, .max = 1});
  v.value("width", options.width,
          {.doc = "width of the square that frames show", .min = 1e-12, .max = 1});
  v.value("zooms", options.zooms,
          {.doc = "frames, all of the last corrugation, each nearer than the one before and "
                  "magnified as much; absent: a frame is a corrugation",
           .min = 1,
           .max = 20});
  v.value("nearer", options.nearer,
          {.doc = "factor by which each of these frames is narrower than the one before",
           .min = 1.01,
           .max = 1000});
}

void describe(OptionVisitor& v, DetailOptions& options) {
  v.value("x", options.x,
          {.doc = "x of the detail's centre in the unit square", .min = 0, .max = 1});
  v.value("y", options.y,
          {.doc = "y of the detail's centre in the unit square", .min = 0, .max = 1});
  v.value("width", options.width,
          {.doc = "width of the detail in the unit square", .min = 1e-12, .max = 1});
}

void describe(OptionVisitor& v, PrintOptions& options) {
  v.value("size", options.size,
          {.doc = "largest extent of the printed surface", .unit = "m", .min = 1e-6, .max = 1000});
  v.value("thickness", options.thickness,
          {.doc = "least thickness of the wall around a round cavity of a whole torus, or of the "
                  "plate below a view; 0: a whole torus is solid, a view is refused",
           .unit = "m",
           .min = 0,
           .max = 100});
}

void describe(OptionVisitor& v, TorusSceneOptions& options) {
  v.value("r1", options.r1,
          {.doc = "radius r1 of the tube of the torus of revolution, over 1 / (2 pi)",
           .min = 1e-6,
           .max = 1});
  v.value(
      "r2", options.r2,
      {.doc = "radius r2 of its centre line, over 1 / (2 pi); r1 + r2 < 1", .min = 1e-6, .max = 1});
  describe_list(v, "corrugations", options.corrugations,
                {.doc = "corrugations, one after the other"});
  v.value("margin", options.margin,
          {.doc = "part of each next coefficient that a number N which is chosen leaves",
           .min = 0.01,
           .max = 0.99});
  v.value("surface", options.surface,
          {.doc = "points along each side of the surface that frames hold", .min = 4, .max = 1000});
  v.value("windows", options.windows,
          {.doc = "places, drawn in the square, at which the metric is measured",
           .min = 1,
           .max = 20000});
  v.value("window_seed", options.window_seed,
          {.doc = "seed of these places, added to that of the experiment", .min = 0});
  describe_group(
      v, "view", options.view,
      {.doc = "a square part of the torus, which alone is shown; absent: the whole torus"});
  describe_group(v, "detail", options.detail,
                 {.doc = "part \"detail\" of frames: as many points of a small part of the torus, "
                         "turned upright and magnified to a width of 1; not with `view.zooms`"});
  v.value("whole", options.whole,
          {.doc = "points along each side of the whole torus after the last corrugation, written "
                  "as the artifact grid.vti; absent: it is not",
           .min = 4,
           .max = 4000});
  describe_group(v, "print", options.print,
                 {.doc = "surface.stl, a closed body, and surface.glb of the last frame"});
}

}  // namespace geoprior::torus
