#include "experiments/fluid/scene/options.h"

namespace geoprior::fluid {
namespace {

constexpr double kSmallest = 1e-9;
constexpr double kLargest = 1e6;

OptionInfo velocity_info() {
  return {.doc = "velocity of the liquid when it is put there", .unit = "m/s"};
}

}  // namespace

void describe(OptionVisitor& v, LiquidShapeOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"box", "sphere", "cylinder", "half-space",
                                                          "mesh"};
  using Kind = LiquidShape::Kind;
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "kind of body, which says what else it is given by"});
  v.value("centre", options.centre,
          {.doc = "centre of the body; where the origin of a mesh goes; a point of the plane of a "
                  "half-space",
           .unit = "m"});
  if (options.kind == Kind::box) {
    v.value("size", options.size, {.doc = "edges of the box", .unit = "m"});
  }
  if (options.kind == Kind::sphere || options.kind == Kind::cylinder) {
    v.value("radius", options.radius,
            {.doc = "radius of the sphere or cylinder", .unit = "m", .min = kSmallest});
  }
  if (options.kind == Kind::cylinder || options.kind == Kind::half_space) {
    v.value("axis", options.axis,
            {.doc = "axis of the cylinder or outward normal of the half-space, of any length"});
  }
  if (options.kind == Kind::cylinder) {
    v.value("length", options.length,
            {.doc = "length of the cylinder along its axis", .unit = "m", .min = kSmallest});
  }
  if (options.kind == Kind::mesh) {
    v.value("file", options.file,
            {.doc = "file of the closed mesh: .obj, .ply, .off, .stl, .vtp, .pvtp",
             .required = true,
             .named = Named::file});
    v.value("scale", options.scale,
            {.doc = "metres for one unit of the file", .unit = "m", .min = kSmallest});
    v.value("turn_z_deg", options.turn_z_deg,
            {.doc = "turn of the mesh about z, before it is placed", .unit = "deg"});
  }
}

void describe(OptionVisitor& v, LiquidVolumeOptions& options) {
  v.value("name", options.name, {.doc = "name of the volume in messages"});
  describe_group(v, "shape", options.shape,
                 {.doc = "body that is filled with liquid at the start"});
  v.value("velocity", options.velocity, velocity_info());
}

void describe(OptionVisitor& v, LiquidSourceOptions& options) {
  v.value("name", options.name, {.doc = "name of the source in messages"});
  describe_group(v, "shape", options.shape,
                 {.doc = "body that is kept full while the source is on"});
  v.value("velocity", options.velocity, velocity_info());
  v.value("from", options.from, {.doc = "time at which the source starts", .unit = "s", .min = 0});
  v.value("until", options.until,
          {.doc = "time at which the source stops", .unit = "s", .min = 0, .required = true});
}

void describe(OptionVisitor& v, TankSolidOptions& options) {
  v.value("name", options.name, {.doc = "name of the solid in messages"});
  describe_group(v, "shape", options.shape, {.doc = "body, where it stands at the start"});
  describe_keys(v, options.keys);
}

void describe(OptionVisitor& v, TankOptions& options) {
  v.value("origin", options.origin, {.doc = "lower corner of the tank", .unit = "m"});
  v.value("size", options.size, {.doc = "edges of the tank, whole numbers of cells", .unit = "m"});
  v.value("cell", options.cell,
          {.doc = "edge h of a cell", .unit = "m", .min = kSmallest, .max = kLargest});
  v.value("open_top", options.open_top, {.doc = "lets liquid leave through the top"});
  v.value("density", options.density,
          {.doc = "density of the liquid", .unit = "kg/m^3", .min = kSmallest});
  describe_list(v, "volumes", options.volumes, {.doc = "liquid that is there at the start"});
  describe_list(v, "sources", options.sources, {.doc = "liquid that is poured in"});
  describe_list(v, "solids", options.solids, {.doc = "bodies that stand still or move"});
}

void describe(OptionVisitor& v, NamedSequenceOptions& options) {
  v.value("name", options.name, {.doc = "name of the animation in edits", .required = true});
  describe(v, options.sequence);
}

void describe(OptionVisitor& v, LibraryOptions& options) {
  v.value("name", options.name, {.doc = "name of the library in edits", .required = true});
  v.value("path", options.path,
          {.doc = "file of the feature library (HDF5)", .required = true, .named = Named::file});
}

void describe(OptionVisitor& v, TargetOptions& options) {
  static constexpr std::array<std::string_view, 4> kKinds{"sequence", "mesh", "ocean", "injected"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "kind of target: an animation, a still mesh, a procedural ocean, the "
                          "scene's injected animation"});
  switch (options.kind) {
    case TargetKind::sequence:
      describe(v, options.sequence);
      break;
    case TargetKind::mesh:
      v.value("file", options.file,
              {.doc = "file of the still mesh: .obj, .ply, .off, .stl, .vtp, .pvtp",
               .required = true,
               .named = Named::file});
      v.value("scale", options.scale,
              {.doc = "metres for one unit of the file", .unit = "m", .min = kSmallest});
      v.value("turn_deg", options.turn_deg,
              {.doc = "turn of the mesh: axis times angle", .unit = "deg"});
      v.value("move", options.move,
              {.doc = "translation of the mesh, after scale and turn", .unit = "m"});
      break;
    case TargetKind::ocean:
      describe_group(v, "ocean", options.ocean, {.doc = "ocean that features are pasted into"});
      v.value("ocean_seed", options.ocean_seed,
              {.doc = "seed of the ocean's waves, beside the experiment's", .min = 0});
      break;
    case TargetKind::injected:
      break;
  }
}

void describe(OptionVisitor& v, FluidSceneOptions& options) {
  v.value("duration", options.duration, {.doc = "time that is animated", .unit = "s", .min = 0});
  v.value("frame_interval", options.frame_interval,
          {.doc = "time between recorded frames", .unit = "s", .min = kSmallest});
  v.value("start", options.start,
          {.doc = "time of the first frame of a paste or an ocean", .unit = "s"});
  v.value("gravity", options.gravity,
          {.doc = "acceleration of gravity, against which is up", .unit = "m/s^2"});
  describe_group(v, "tank", options.tank, {.doc = "tank that a simulation fills"});
  describe_group(v, "injected", options.injected,
                 {.doc = "animation made of known features, the source \"injected\""});
  describe_list(v, "sequences", options.sequences, {.doc = "animations that features come from"});
  describe_list(v, "libraries", options.libraries, {.doc = "stored features that edits take"});
  describe_group(v, "target", options.target,
                 {.doc = "animation, mesh or ocean that features are pasted into"});
  describe_list(v, "edits", options.edits, {.doc = "features that are pasted, and how"});
  v.value("edit_list", options.edit_list,
          {.doc = "TOML file of further edits", .named = Named::file});
}

}  // namespace geoprior::fluid
