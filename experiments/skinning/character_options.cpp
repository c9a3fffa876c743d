#include <algorithm>
#include <array>

#include "core/error.h"
#include "experiments/skinning/characters.h"

namespace geoprior {

void describe(OptionVisitor& v, RefineOptions& options) {
  v.value("region", options.region,
          {.doc = "joints whose skin is refined, as one region; [\"all\"]: the whole mesh"});
  v.value("levels", options.levels, {.doc = "steps of Loop subdivision", .min = 0, .max = 5});
  v.value("extent", options.extent,
          {.doc = "half length of a joint's region along its bones, in local radii",
           .min = 0.1,
           .max = 20});
}

void describe(OptionVisitor& v, CylinderOptions& options) {
  v.value("radius", options.radius, {.doc = "r", .unit = "m", .min = 1e-6});
  v.value("half_length", options.half_length,
          {.doc = "from the joint to either end of the straight part", .unit = "m", .min = 1e-6});
  v.value("cap_height", options.cap_height,
          {.doc = "half axis of the end caps along the bone; 0: flat", .unit = "m", .min = 0});
  v.value("segments", options.segments, {.doc = "vertices of a ring", .min = 3, .max = 100000});
  v.value("rings_per_half", options.rings_per_half,
          {.doc = "rings on one side of the joint", .min = 1, .max = 100000});
  v.value(
      "ramp_width", options.ramp_width,
      {.doc = "length over which the weights pass from bone to bone", .unit = "m", .min = 1e-9});
}

void describe(OptionVisitor& v, FingerOptions& options) {
  v.value("hand_length", options.hand_length,
          {.doc = "stump of the hand before the first joint", .unit = "m", .min = 1e-6});
  v.value("phalanx_length", options.phalanx_length,
          {.doc = "proximal, middle, distal", .unit = "m", .min = 1e-6});
  std::vector<double> radius(options.radius.begin(), options.radius.end());
  v.value("radius", radius,
          {.doc = "at the base of each phalanx and at the tip: four numbers",
           .unit = "m",
           .min = 1e-6});
  if (radius.size() != options.radius.size())
    throw Error(std::to_string(radius.size()) + " numbers", "scene.finger.radius", "4");
  std::copy(radius.begin(), radius.end(), options.radius.begin());
  v.value("segments", options.segments, {.doc = "vertices of a ring", .min = 3, .max = 100000});
  v.value("ramp_width", options.ramp_width,
          {.doc = "of the weights about a joint, in local radii", .min = 1e-6, .max = 10});
  v.value("ring_spacing", options.ring_spacing,
          {.doc = "distance of rings in edge lengths of a ring", .min = 0.01, .max = 100});
}

void describe(OptionVisitor& v, CharacterOptions& options) {
  static constexpr std::array<std::string_view, 3> kWeights{"file-or-heat", "file", "heat"};
  v.value("character", options.character,
          {.doc = "\"human\", \"cylinder\", \"finger\", or a .glb or .gltf file"});
  v.value("mesh", options.mesh,
          {.doc = "name of the file's mesh; absent: all meshes of its first skin, else all"});
  v.value("skeleton", options.skeleton,
          {.doc = "skeleton file that overrides the file's hierarchy"});
  v.value("unit_m", options.unit_m,
          {.doc = "metres for one unit of the file", .unit = "m", .min = 1e-9, .max = 1e9});
  describe_choice(v, "weights", options.weights, kWeights,
                  {.doc = "weights of the file, or by bone heat diffusion"});
  describe_group(v, "heat", options.heat, {.doc = "bone heat diffusion"});
  describe_group(v, "cylinder", options.cylinder, {.doc = "shape of character = \"cylinder\""});
  describe_group(v, "finger", options.finger, {.doc = "shape of character = \"finger\""});
  v.value("simplify_to", options.simplify_to,
          {.doc = "collapse edges until so many vertices are left (heat weights), before refining",
           .min = 4});
  describe_list(v, "refine", options.refine,
                {.doc = "Loop subdivision of the whole mesh or of regions, in order"});
}

}  // namespace geoprior
