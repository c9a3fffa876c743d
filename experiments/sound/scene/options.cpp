#include "experiments/sound/scene/options.h"

namespace geoprior::sound {

void describe(OptionVisitor& v, HeardMaterial& options) {
  PaperMaterial& m = options.paper;
  paper::describe_plate(v, m);
  v.value("friction", m.friction,
          {.doc = "Coulomb coefficient of friction between paper and obstacles",
           .min = 0,
           .max = paper::kRoughest});
}

void describe(OptionVisitor& v, HoldOptions& options) {
  paper::HandleOptions& h = options.handle;
  describe_list(v, "points", h.points, {.doc = "points of the pattern that are held"});
  v.value("segment", h.segment,
          {.doc = "straight line of the pattern that is held: u v of one end, u v of the other",
           .unit = "m"});
  describe_group(v, "disc", h.disc, {.doc = "disc of the pattern that is held"});
  describe_list(v, "active", h.active, {.doc = "times at which it holds; empty: always"});
}

void describe(OptionVisitor& v, OtherAnimationOptions& options) {
  v.value("name", options.name, {.doc = "what variants call it", .required = true});
  v.value("path", options.path,
          {.doc = "frames, as those of the animation",
           .required = true,
           .named = Named::file_or_folder});
}

void describe(OptionVisitor& v, SoundSceneOptions& options) {
  describe_group(v, "pattern", options.pattern, {.doc = "flat shape of the animated sheet"});
  describe_group(v, "material", options.material,
                 {.doc = "material of the sheet; default: office paper, 80 g/m^2"});
  describe_group(v, "toughness", options.toughness,
                 {.doc = "resistance that a tear overcomes, and that is heard"});
  describe_list(v, "handles", options.handles,
                {.doc = "what holds the sheet: no resonator reaches across it"});
  describe_list(v, "obstacles", options.obstacles, {.doc = "bodies that the sheet slides along"});
  describe_group(v, "animation", options.animation,
                 {.doc = "frames of a sheet with coordinates of the pattern: files, or a run's"});
  describe_list(
      v, "others", options.others,
      {.doc = "animations of the sheet by other methods or on other meshes: variants listen to one "
              "of them by their option animation"});
  describe_group(v, "swatches", options.swatches,
                 {.doc = "instead of an animation: rectangles of paper of given lengths that snap "
                         "one after the other; pattern and handles are then theirs"});
  v.value("bank", options.bank,
          {.doc = "folder with a bank of sounds, bank.csv and WAV files (docs/file-formats.md); "
                  "absent: methods of sound generate theirs",
           .named = Named::folder});
}

}  // namespace geoprior::sound
