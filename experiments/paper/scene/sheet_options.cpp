#include "experiments/paper/scene/sheet_options.h"

namespace geoprior::paper {
namespace {

constexpr double kLargest = 1e6;

}  // namespace

void describe(OptionVisitor& v, PatternPointOptions& options) {
  v.value("u", options.u, {.doc = "first coordinate", .unit = "m", .required = true});
  v.value("v", options.v, {.doc = "second coordinate", .unit = "m", .required = true});
}

void describe(OptionVisitor& v, HoleOptions& options) {
  describe_list(v, "points", options.points,
                {.doc = "corners in order, either way round", .required = true});
}

void describe(OptionVisitor& v, CutOptions& options) {
  describe_list(
      v, "points", options.points,
      {.doc = "from one end to the other; an end on the border, on a hole or on an earlier "
              "cut opens it, another is a tip",
       .required = true});
}

void describe(OptionVisitor& v, ToughnessOptions& options) {
  v.value("energy", options.energy,
          {.doc = "K, that tearing a unit of area of the section takes; absent: it does not tear",
           .unit = "J/m^2",
           .min = 1e-9,
           .max = 1e9});
  v.value("noise", options.noise,
          {.doc = "depth of the texture T, which lies between 1 - noise and 1",
           .min = 0,
           .max = 1 - 1e-9});
  v.value("noise_length", options.noise_length,
          {.doc = "of the waves of the texture", .unit = "m", .min = 1e-6, .max = kLargest});
  v.value("seed", options.seed, {.doc = "of the texture", .min = 0});
  v.value("grain_deg", options.grain_deg,
          {.doc = "direction of the fibres in the pattern, from u towards v", .unit = "deg"});
  v.value(
      "across", options.across,
      {.doc = "K across the fibres over K along them; needs grain_deg", .min = 1e-6, .max = 1e6});
}

void describe(OptionVisitor& v, PatternOptions& options) {
  static constexpr std::array<std::string_view, 4> kKinds{"rectangle", "disc", "polygon", "svg"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "rectangle: width, height; disc: radius, corners; polygon: points; svg: "
                          "file, path, unit_m, tolerance, centred; holes of all but svg"});
  switch (options.kind) {
    case PatternKind::rectangle:
      v.value("width", options.width,
              {.doc = "along u", .unit = "m", .min = 1e-6, .max = kLargest});
      v.value("height", options.height,
              {.doc = "along v", .unit = "m", .min = 1e-6, .max = kLargest});
      break;
    case PatternKind::disc:
      v.value("radius", options.radius,
              {.doc = "of the circle about the origin", .unit = "m", .min = 1e-6, .max = kLargest});
      v.value("corners", options.corners, {.doc = "of its outline", .min = 3, .max = kMostCorners});
      break;
    case PatternKind::polygon:
      describe_list(v, "points", options.points,
                    {.doc = "corners in order, either way round", .required = true});
      break;
    case PatternKind::svg:
      v.value("file", options.file, {.doc = "SVG file", .required = true});
      v.value("path", options.svg.path,
              {.doc = "id of the path, polygon, polyline, rect, circle or ellipse, its subpaths "
                      "border and holes; absent: the only one"});
      v.value("unit_m", options.svg.unit_m,
              {.doc = "metres for one unit of the outermost viewBox",
               .unit = "m",
               .min = 1e-9,
               .max = kLargest});
      v.value("tolerance", options.svg.tolerance,
              {.doc = "largest distance of a curve from its chords", .unit = "m", .min = 1e-9});
      v.value("centred", options.svg.centred, {.doc = "middle of the shape's box at the origin"});
      break;
  }
  if (options.kind != PatternKind::svg) {
    describe_list(v, "holes", options.holes, {.doc = "polygons that are cut out of it"});
  }
  describe_list(v, "cuts", options.cuts, {.doc = "lines along which it is open from the start"});
}

void describe(OptionVisitor& v, PaperMaterial& options) {
  v.value("thickness", options.thickness, {.doc = "h", .unit = "m", .min = 1e-9, .max = 1});
  v.value("young_modulus", options.young_modulus, {.doc = "E", .unit = "Pa", .min = 1e-3});
  v.value("poisson_ratio", options.poisson_ratio, {.doc = "nu", .min = 0, .max = 0.499});
  v.value("area_density", options.area_density,
          {.doc = "mass of an area", .unit = "kg/m^2", .min = 1e-9});
  v.value("yield_curvature", options.yield_curvature,
          {.doc = "elastic curvature beyond which the sheet creases", .unit = "1/m", .min = 1e-9});
  v.value("weakening", options.weakening,
          {.doc = "bending stiffness falls by 1 / (1 + weakening * damage)", .min = 0});
  v.value("friction", options.friction, {.doc = "Coulomb, against obstacles", .min = 0});
  v.value("grain_deg", options.grain_deg,
          {.doc = "direction of the fibres in the pattern, from u towards v", .unit = "deg"});
  v.value("along", options.along,
          {.doc = "bending stiffness along the fibres over that across them; needs grain_deg",
           .min = 1e-3,
           .max = 1e3});
  v.value("damping", options.damping,
          {.doc = "proportional to stiffness (Rayleigh)", .unit = "s", .min = 0});
}

void describe(OptionVisitor& v, IntervalOptions& options) {
  v.value("from", options.from, {.doc = "first time", .unit = "s", .required = true});
  v.value("to", options.to, {.doc = "last time", .unit = "s", .required = true});
}

void describe(OptionVisitor& v, DiscOptions& options) {
  v.value("u", options.u, {.doc = "centre", .unit = "m", .required = true});
  v.value("v", options.v, {.doc = "centre", .unit = "m", .required = true});
  v.value("radius", options.radius, {.doc = "of the disc", .unit = "m", .min = 1e-9});
}

void describe(OptionVisitor& v, HandleOptions& options) {
  v.value("name", options.name, {.doc = "for messages"});
  describe_list(v, "points", options.points, {.doc = "points of the pattern that are held, or …"});
  v.value("segment", options.segment,
          {.doc = "… a straight line of it: u v of one end, u v of the other, or …", .unit = "m"});
  describe_group(v, "disc", options.disc, {.doc = "… a disc of it"});
  describe_keys(v, options.keys);
  v.value("stiffness", options.stiffness,
          {.doc = "of a hand that gives: what it holds departs from its place by the force over "
                  "this; absent: not at all",
           .unit = "N/m",
           .min = 1e-6,
           .max = 1e9});
  v.value("force", options.force,
          {.doc = "instead of keys: x y z of a dead load, spread over the shape", .unit = "N"});
  describe_list(v, "active", options.active,
                {.doc = "times at which it holds or pulls; empty: always"});
}

void describe(OptionVisitor& v, RadiusKeyOptions& options) {
  v.value("t", options.t, {.doc = "time", .unit = "s", .required = true});
  v.value("radius", options.radius,
          {.doc = "at that time, linear between", .unit = "m", .min = 1e-9, .required = true});
}

void describe(OptionVisitor& v, ObstacleOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"plane", "sphere", "cylinder",
                                                          "hollow-sphere", "torus"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "plane: centre, axis (its normal); sphere, hollow-sphere (the sheet is "
                          "inside): centre, radius; cylinder: centre, axis, radius, half_length; "
                          "torus: centre, axis, radius, tube_radius"});
  v.value("name", options.name, {.doc = "for messages"});
  v.value("centre", options.centre, {.doc = "at the start", .unit = "m"});
  if (options.kind == Obstacle::Kind::plane || options.kind == Obstacle::Kind::cylinder ||
      options.kind == Obstacle::Kind::torus) {
    v.value("axis", options.axis, {.doc = "normal or axis, any length"});
  }
  if (options.kind != Obstacle::Kind::plane) {
    v.value("radius", options.radius, {.doc = "of the body or ring", .unit = "m", .min = 1e-9});
    describe_list(v, "radii", options.radii, {.doc = "radius over time; empty: constant"});
  }
  if (options.kind == Obstacle::Kind::torus) {
    v.value("tube_radius", options.tube_radius, {.doc = "of the wire", .unit = "m", .min = 1e-9});
  }
  if (options.kind == Obstacle::Kind::cylinder) {
    v.value("half_length", options.half_length, {.doc = "0: endless", .unit = "m", .min = 0});
  }
  describe_keys(v, options.keys);
}

}  // namespace geoprior::paper
