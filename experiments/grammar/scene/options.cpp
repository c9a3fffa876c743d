#include "experiments/grammar/scene/options.h"

namespace geoprior::grammar {
namespace {

constexpr std::array<std::string_view, 8> kObjects{
    "tree", "building", "surface-set", "volume-set", "landscape", "forest", "arm", "imported"};

void describe_object(OptionVisitor& v, GrammarSceneOptions& options) {
  switch (options.object) {
    case Object::tree:
      return describe_group(v, "tree", options.tree, {.doc = "the tree"});
    case Object::building:
      return describe_group(v, "building", options.building, {.doc = "the building"});
    case Object::surface_set:
      return describe_group(v, "surface_set", options.surface_set,
                            {.doc = "the surface and the elements on it"});
    case Object::volume_set:
      return describe_group(v, "volume_set", options.volume_set,
                            {.doc = "the body and the elements in it"});
    case Object::landscape:
      return describe_group(v, "landscape", options.landscape,
                            {.doc = "the terrain and what stands on it"});
    case Object::forest:
      return describe_group(v, "forest", options.forest, {.doc = "the forest on flat ground"});
    case Object::arm:
      return describe_group(v, "arm", options.arm, {.doc = "the chain of joints"});
    case Object::imported:
      return describe_group(v, "imported", options.imported,
                            {.doc = "the scene of another program"});
  }
}

}  // namespace

void describe(OptionVisitor& v, ImportedOptions& options) {
  v.value("file", options.file,
          {.doc = "glTF scene (.glb, .gltf) whose nodes are the elements",
           .required = true,
           .named = Named::file});
  v.value("unit", options.unit,
          {.doc = "length of the scene's unit", .unit = "m", .min = 1e-6, .max = 1e6});
}

void describe(OptionVisitor& v, EditOptions& options) {
  constexpr std::array<std::string_view, 5> kKinds{"translate", "turn", "set", "extrude",
                                                   "children"};
  constexpr std::array<std::string_view, 3> kKeeps{"rigid", "stop", "no"};
  v.value("element", options.element,
          {.doc = "element that is edited: type and number, or its name", .required = true});
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "what is done to the element: moved, turned about where it is at rest, a "
                          "parameter set or made larger, given more children or fewer"});
  v.value("by", options.by, {.doc = "shift of an element that is moved", .unit = "m"});
  v.value("axis", options.axis, {.doc = "axis that an element is turned about"});
  v.value("angle_deg", options.angle_deg,
          {.doc = "angle that an element is turned by", .unit = "deg", .min = -360, .max = 360});
  v.value("parameter", options.parameter, {.doc = "name of the parameter that is edited"});
  v.value(
      "value", options.value,
      {.doc =
           "value that a parameter is set to or grows by; how many children come (a whole number; "
           "negative: go)"});
  describe_choice(
      v, "keep", options.keep, kKeeps,
      {.doc = "what a later deformation from above does to the edited element: moves it "
              "rigidly, leaves it where it is, or whatever it does to all"});
}

void describe(OptionVisitor& v, RandomGestureOptions& options) {
  v.value("count", options.count,
          {.doc = "random gestures, a frame each", .min = 1, .max = 100000});
  v.value("first", options.first,
          {.doc = "number of the first random gesture", .min = 0, .max = 1000000});
}

void describe(OptionVisitor& v, GestureOptions& options) {
  constexpr std::array<std::string_view, 2> kCourses{"once", "back"};
  v.value("file", options.file,
          {.doc = "recorded strokes, a lattice or a cage (.toml)",
           .required = true,
           .named = Named::file});
  v.value("element", options.element,
          {.doc = "element that the gesture is for, with all below it; empty: the root"});
  v.value("steps", options.steps,
          {.doc = "steps of the gesture, a frame each", .min = 1, .max = 100000});
  describe_choice(v, "course", options.course, kCourses,
                  {.doc = "whether the gesture ends done or goes back to its start"});
  v.value("repeats", options.repeats,
          {.doc = "times that the gesture is made, one after the other", .min = 1, .max = 1000});
  v.value("scale", options.scale,
          {.doc = "factor of all lengths of the recorded gesture", .min = 1e-3, .max = 1e3});
}

void describe(OptionVisitor& v, GrammarSceneOptions& options) {
  constexpr std::array<std::string_view, 3> kRecords{"surface", "keys", "sample"};
  describe_choice(v, "object", options.object, kObjects, {.doc = "what is deformed"});
  describe_object(v, options);
  v.value(
      "seed", options.seed,
      {.doc = "number of the object among those of the experiment's seed", .min = 1, .max = 1e6});
  describe_list(v, "edits", options.edits,
                {.doc = "edits of single elements before the gesture, in order, a frame each"});
  describe_group(v, "gesture", options.gesture, {.doc = "a recorded gesture; absent: none"});
  describe_group(v, "random", options.random,
                 {.doc = "random gestures, each from the state after the edits; absent: none"});
  v.value("rules", options.rules,
          {.doc = "script of rules (.lua) for methods that are told to use it; empty: none",
           .named = Named::file});
  describe_choice(
      v, "record", options.record, kRecords,
      {.doc = "what frames hold: triangles and key points, key points, or key points of "
              "every so many elements, about a thousand"});
}

}  // namespace geoprior::grammar
