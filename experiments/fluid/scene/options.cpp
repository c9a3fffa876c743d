#include "experiments/fluid/scene/options.h"

namespace geoprior::fluid {
namespace {

constexpr double kSmallest = 1e-9;
constexpr double kLargest = 1e6;

OptionInfo velocity_info() { return {.doc = "of the liquid put there", .unit = "m/s"}; }

}  // namespace

void describe(OptionVisitor& v, LiquidShapeOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"box", "sphere", "cylinder", "half-space",
                                                          "mesh"};
  using Kind = LiquidShape::Kind;
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "box: centre, size; sphere: centre, radius; cylinder: centre, axis, "
                          "radius, length; half-space: centre (a point of its plane), axis (out of "
                          "it); mesh: file, scale, turn_z_deg, centre (where its origin goes)"});
  v.value("centre", options.centre, {.doc = "place", .unit = "m"});
  if (options.kind == Kind::box) {
    v.value("size", options.size, {.doc = "edges", .unit = "m"});
  }
  if (options.kind == Kind::sphere || options.kind == Kind::cylinder) {
    v.value("radius", options.radius, {.doc = "of the body", .unit = "m", .min = kSmallest});
  }
  if (options.kind == Kind::cylinder || options.kind == Kind::half_space) {
    v.value("axis", options.axis, {.doc = "axis or outward normal, any length"});
  }
  if (options.kind == Kind::cylinder) {
    v.value("length", options.length, {.doc = "along the axis", .unit = "m", .min = kSmallest});
  }
  if (options.kind == Kind::mesh) {
    v.value("file", options.file, {.doc = "closed mesh: .obj, .ply, .off, .vtp", .required = true});
    v.value("scale", options.scale,
            {.doc = "metres for one unit of the file", .unit = "m", .min = kSmallest});
    v.value("turn_z_deg", options.turn_z_deg,
            {.doc = "about z, before it is placed", .unit = "deg"});
  }
}

void describe(OptionVisitor& v, LiquidVolumeOptions& options) {
  v.value("name", options.name, {.doc = "for messages"});
  describe_group(v, "shape", options.shape, {.doc = "filled with liquid at the start"});
  v.value("velocity", options.velocity, velocity_info());
}

void describe(OptionVisitor& v, LiquidSourceOptions& options) {
  v.value("name", options.name, {.doc = "for messages"});
  describe_group(v, "shape", options.shape, {.doc = "kept full while the source is on"});
  v.value("velocity", options.velocity, velocity_info());
  v.value("from", options.from, {.doc = "first time", .unit = "s", .min = 0});
  v.value("until", options.until, {.doc = "last time", .unit = "s", .min = 0, .required = true});
}

void describe(OptionVisitor& v, TankSolidOptions& options) {
  v.value("name", options.name, {.doc = "for messages"});
  describe_group(v, "shape", options.shape, {.doc = "where it stands at the start"});
  describe_keys(v, options.keys);
}

void describe(OptionVisitor& v, TankOptions& options) {
  v.value("origin", options.origin, {.doc = "lower corner", .unit = "m"});
  v.value("size", options.size, {.doc = "edges, whole numbers of cells", .unit = "m"});
  v.value("cell", options.cell,
          {.doc = "edge of a cell, h", .unit = "m", .min = kSmallest, .max = kLargest});
  v.value("open_top", options.open_top, {.doc = "liquid may leave through the top"});
  v.value("density", options.density, {.doc = "of the liquid", .unit = "kg/m^3", .min = kSmallest});
  describe_list(v, "volumes", options.volumes, {.doc = "liquid that is there at the start"});
  describe_list(v, "sources", options.sources, {.doc = "liquid that is poured in"});
  describe_list(v, "solids", options.solids, {.doc = "bodies that stand still or move"});
}

void describe(OptionVisitor& v, NamedSequenceOptions& options) {
  v.value("name", options.name, {.doc = "what edits call it", .required = true});
  describe(v, options.sequence);
}

void describe(OptionVisitor& v, LibraryOptions& options) {
  v.value("name", options.name, {.doc = "what edits call it", .required = true});
  v.value("path", options.path, {.doc = "feature library (HDF5)", .required = true});
}

void describe(OptionVisitor& v, TargetOptions& options) {
  static constexpr std::array<std::string_view, 4> kKinds{"sequence", "mesh", "ocean", "injected"};
  describe_choice(
      v, "kind", options.kind, kKinds,
      {.doc = "sequence: an animation; mesh: one still surface; ocean: procedural; injected: "
              "the scene's made animation"});
  switch (options.kind) {
    case TargetKind::sequence:
      describe(v, options.sequence);
      break;
    case TargetKind::mesh:
      v.value("file", options.file, {.doc = "mesh: .obj, .ply, .off, .vtp", .required = true});
      v.value("scale", options.scale,
              {.doc = "metres for one unit of the file", .unit = "m", .min = kSmallest});
      v.value("turn_deg", options.turn_deg, {.doc = "axis times angle", .unit = "deg"});
      v.value("move", options.move, {.doc = "after scale and turn", .unit = "m"});
      break;
    case TargetKind::ocean:
      describe_group(v, "ocean", options.ocean, {.doc = "spectrum and patch"});
      v.value("ocean_seed", options.ocean_seed,
              {.doc = "of its waves, beside the experiment's", .min = 0});
      break;
    case TargetKind::injected:
      break;
  }
}

void describe(OptionVisitor& v, FluidSceneOptions& options) {
  v.value("duration", options.duration, {.doc = "animated time", .unit = "s", .min = 0});
  v.value("frame_interval", options.frame_interval,
          {.doc = "time between recorded frames", .unit = "s", .min = kSmallest});
  v.value("start", options.start, {.doc = "time of the first frame of a paste", .unit = "s"});
  v.value("gravity", options.gravity, {.doc = "acceleration; up is against it", .unit = "m/s^2"});
  describe_group(v, "tank", options.tank, {.doc = "what a simulation fills"});
  describe_group(v, "injected", options.injected,
                 {.doc = "made animation with known features, the source \"injected\""});
  describe_list(v, "sequences", options.sequences, {.doc = "animations that features come from"});
  describe_list(v, "libraries", options.libraries, {.doc = "stored features"});
  describe_group(v, "target", options.target, {.doc = "what features are pasted into"});
  describe_list(v, "edits", options.edits, {.doc = "what is pasted, and how"});
  v.value("edit_list", options.edit_list, {.doc = "TOML file of further edits"});
}

}  // namespace geoprior::fluid
