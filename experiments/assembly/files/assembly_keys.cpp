#include <array>
#include <string_view>

#include "experiments/assembly/files/assembly_file.h"
#include "testbed/runner/options/listing.h"

namespace geoprior::assembly {
namespace {

/// Largest coordinate and length of a file (m).
constexpr double kFarthestInFile = 1e6;

constexpr std::array<std::string_view, 7> kSolidKinds{"box",   "cylinder", "sphere", "lathe",
                                                      "prism", "channel",  "rail"};

void describe_outline(OptionVisitor& v, SolidEntry& solid) {
  const bool is_lathe = solid.kind == SolidKind::lathe;
  v.value("outline", solid.outline,
          {.doc = is_lathe ? "closed outline [[r, z], …], radius and height, turned about z"
                           : "closed outline [[x, y], …]",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile});
}

void describe_swept(OptionVisitor& v, SolidEntry& solid) {
  v.value("points", solid.points,
          {.doc = "poly-line [[x, y, z], …] that it is swept along: the bottom of a groove, the "
                  "middle of a bar's underside; absent: each way of the part",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile});
  v.value("width", solid.width,
          {.doc = "width, of a channel inside",
           .unit = "m",
           .min = 0,
           .max = kFarthestInFile,
           .required = true});
  if (solid.kind == SolidKind::channel) {
    v.value("depth", solid.depth,
            {.doc = "depth of the groove",
             .unit = "m",
             .min = 0,
             .max = kFarthestInFile,
             .required = true});
    v.value("wall", solid.wall,
            {.doc = "thickness beside and below the groove",
             .unit = "m",
             .min = 0,
             .max = kFarthestInFile,
             .required = true});
  } else {
    v.value("height", solid.height,
            {.doc = "height", .unit = "m", .min = 0, .max = kFarthestInFile, .required = true});
  }
  v.value("offset", solid.offset,
          {.doc = "shift to the left of the poly-line",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile});
}

}  // namespace

void describe(OptionVisitor& v, PortEntry& port) {
  v.value("name", port.name, {.doc = "name within the part", .required = true});
  v.value("at", port.at,
          {.doc = "where it is",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile,
           .required = true});
  v.value("out", port.out, {.doc = "direction out of the part", .required = true});
  v.value("up", port.up, {.doc = "direction that stays upright when it is joined"});
}

void describe(OptionVisitor& v, WayEntry& way) {
  v.value("from", way.from, {.doc = "port where it begins; absent: inside of the part"});
  v.value("to", way.to, {.doc = "port where it ends; absent: inside of the part"});
  v.value("points", way.points,
          {.doc = "poly-line [[x, y, z], …]",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile,
           .required = true});
}

void describe(OptionVisitor& v, SolidEntry& solid) {
  describe_choice(v, "kind", solid.kind, kSolidKinds, {.doc = "kind of primitive"});
  v.value("at", solid.at,
          {.doc = "where its origin is put: the middle of a box, a cylinder or a sphere",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile});
  v.value("turn_deg", solid.turn_deg,
          {.doc = "turns about the axes x, y, z, in this order, before it is put there",
           .unit = "deg"});
  const SolidKind kind = solid.kind;
  if (kind != SolidKind::sphere && kind != SolidKind::lathe)
    v.value("round", solid.round,
            {.doc = "radius of its edges", .unit = "m", .min = 0, .max = kFarthestInFile});
  switch (kind) {
    case SolidKind::box:
      v.value("size", solid.size,
              {.doc = "lengths of its sides",
               .unit = "m",
               .min = -kFarthestInFile,
               .max = kFarthestInFile,
               .required = true});
      break;
    case SolidKind::cylinder:
      v.value("top_radius", solid.top_radius,
              {.doc = "radius at its other end; absent: the same",
               .unit = "m",
               .min = 0,
               .max = kFarthestInFile});
      v.value("length", solid.length,
              {.doc = "length along z",
               .unit = "m",
               .min = 0,
               .max = kFarthestInFile,
               .required = true});
      [[fallthrough]];
    case SolidKind::sphere:
      v.value("radius", solid.radius,
              {.doc = "radius", .unit = "m", .min = 0, .max = kFarthestInFile, .required = true});
      break;
    case SolidKind::prism:
      v.value("height", solid.height,
              {.doc = "height along z",
               .unit = "m",
               .min = 0,
               .max = kFarthestInFile,
               .required = true});
      [[fallthrough]];
    case SolidKind::lathe:
      describe_outline(v, solid);
      break;
    case SolidKind::channel:
    case SolidKind::rail:
      describe_swept(v, solid);
      break;
  }
}

void describe(OptionVisitor& v, PartEntry& part) {
  v.value("label", part.label, {.doc = "kind of part: letters, digits, - and _", .required = true});
  describe_list(v, "ports", part.ports, {.doc = "where it can be joined, in order"});
  describe_list(v, "ways", part.ways, {.doc = "ways of a ball or a train through it"});
  v.value(
      "symmetries", part.symmetries,
      {.doc = "motions onto itself, each a text: for every port, in order, the name of the port "
              "that it comes to; absent: they are found"});
  v.value("mesh", part.mesh,
          {.doc = "body in m, a mesh file beside this file", .named = Named::file});
  describe_list(v, "solids", part.solids, {.doc = "primitives that make up its body"});
}

void describe(OptionVisitor& v, ModelPartEntry& part) {
  v.value("id", part.id, {.doc = "name within the model", .required = true});
  v.value("part", part.part, {.doc = "label of its kind", .required = true});
}

void describe(OptionVisitor& v, PlaceEntry& place) {
  v.value("part", place.part, {.doc = "id of the part that is put there", .required = true});
  v.value("at", place.at,
          {.doc = "where its origin is put",
           .unit = "m",
           .min = -kFarthestInFile,
           .max = kFarthestInFile});
  v.value("turn_deg", place.turn_deg, {.doc = "turn about z", .unit = "deg"});
}

void describe(OptionVisitor& v, ModelEntry& model) {
  v.value("name", model.name, {.doc = "letters, digits, - and _", .required = true});
  describe_list(v, "parts", model.parts, {.doc = "parts of the model"});
  v.value("joints", model.joints, {.doc = "pairs of joined ports, \"id.port id.port\""});
  describe_list(v, "place", model.place,
                {.doc = "pose of one part of each piece of the model, the others follow; absent: "
                        "the first part is at the origin"});
}

void describe(OptionVisitor& v, AssemblyFile& file) {
  v.value("include", file.include,
          {.doc = "other assembly files, read first", .named = Named::file});
  describe_list(v, "part", file.parts, {.doc = "kinds of parts"});
  describe_list(v, "model", file.models,
                {.doc = "models: which parts there are and what is joined"});
}

TopicFile assembly_keys() {
  AssemblyFile file;
  return {"assembly", "parts that can be joined at ports, and models made of them",
          "[[part]] and [[model]]", list_options([&](OptionVisitor& v) { describe(v, file); })};
}

}  // namespace geoprior::assembly
