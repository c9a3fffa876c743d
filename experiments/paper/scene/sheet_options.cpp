#include "experiments/paper/scene/sheet_options.h"

namespace geoprior::paper {
namespace {

constexpr double kLargest = 1e6;

// Beyond what there is, a factor of ten or more: diamond has 1.2e12 Pa, osmium a metre thick
// 2.3e4 kg/m^2, rubber on rubber a friction of 4; a thinnest sheet bends to 1/h = 1e9 1/m.
constexpr double kStiffest = 1e13;
constexpr double kHeaviest = 1e6;
constexpr double kSharpest = 1e10;
constexpr double kSlowest = 1e3;

}  // namespace

void describe(OptionVisitor& v, PatternPointOptions& options) {
  v.value("u", options.u,
          {.doc = "first coordinate of a point of the pattern", .unit = "m", .required = true});
  v.value("v", options.v,
          {.doc = "second coordinate of a point of the pattern", .unit = "m", .required = true});
}

void describe(OptionVisitor& v, HoleOptions& options) {
  describe_list(v, "points", options.points,
                {.doc = "corners of a hole in order, either way round", .required = true});
}

void describe(OptionVisitor& v, CutOptions& options) {
  describe_list(v, "points", options.points,
                {.doc = "points of a cut from one end to the other; an end on the border, on a "
                        "hole or on an earlier cut opens it, another is a tip",
                 .required = true});
}

void describe(OptionVisitor& v, ToughnessOptions& options) {
  v.value("energy", options.energy,
          {.doc = "energy K that tearing a unit of area of the section takes; absent: the paper "
                  "does not tear",
           .unit = "J/m^2",
           .min = 1e-9,
           .max = 1e9});
  v.value("noise", options.noise,
          {.doc = "depth of the texture of the toughness, which lies between 1 - noise and 1",
           .min = 0,
           .max = 1 - 1e-9});
  v.value("noise_length", options.noise_length,
          {.doc = "length of the waves of the texture of the toughness",
           .unit = "m",
           .min = 1e-6,
           .max = kLargest});
  v.value(
      "seed", options.seed,
      {.doc = "seed of the texture of the toughness, added to that of the experiment", .min = 0});
  v.value("grain_deg", options.grain_deg,
          {.doc = "direction of the fibres that tears follow, from u towards v", .unit = "deg"});
  v.value("across", options.across,
          {.doc = "toughness across the fibres over that along them; needs grain_deg",
           .min = 1e-6,
           .max = 1e6});
}

void describe(OptionVisitor& v, PatternOptions& options) {
  static constexpr std::array<std::string_view, 4> kKinds{"rectangle", "disc", "polygon", "svg"};
  static constexpr std::array<std::string_view, 3> kScales{"guess", "page", "viewbox"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "rectangle: width, height; disc: radius, corners; polygon: points; svg: "
                          "file, path, unit, unit_m, tolerance, centred; holes of all but svg"});
  switch (options.kind) {
    case PatternKind::rectangle:
      v.value("width", options.width,
              {.doc = "width of a rectangle, along u", .unit = "m", .min = 1e-6, .max = kLargest});
      v.value("height", options.height,
              {.doc = "height of a rectangle, along v", .unit = "m", .min = 1e-6, .max = kLargest});
      break;
    case PatternKind::disc:
      v.value(
          "radius", options.radius,
          {.doc = "radius of a disc about the origin", .unit = "m", .min = 1e-6, .max = kLargest});
      v.value("corners", options.corners,
              {.doc = "number of corners of the outline of a disc", .min = 3, .max = kMostCorners});
      break;
    case PatternKind::polygon:
      describe_list(v, "points", options.points,
                    {.doc = "corners of a polygon in order, either way round", .required = true});
      break;
    case PatternKind::svg:
      v.value("file", options.file,
              {.doc = "SVG file that the pattern is read from",
               .required = true,
               .named = Named::file});
      v.value("path", options.svg.path,
              {.doc = "id of the path, polygon, polyline, rect, circle, ellipse, use or group, its "
                      "lines border and holes; absent: the only one"});
      describe_choice(v, "unit", options.svg.unit, kScales,
                      {.doc = "what says how large a unit of the outermost viewBox is: the page's "
                              "size, unit_m (viewbox), or unit_m where it is given and the page "
                              "where it has a size in mm, cm, in, pt or pc (guess)"});
      v.value(
          "unit_m", options.svg.unit_m,
          {.doc =
               "metres for one unit of the outermost viewBox; absent: 0.001, or as the page has it",
           .unit = "m",
           .min = 1e-9,
           .max = kLargest});
      v.value("tolerance", options.svg.tolerance,
              {.doc = "largest distance of a curve of the drawing from its chords",
               .unit = "m",
               .min = 1e-9,
               .max = kLargest});
      v.value("centred", options.svg.centred,
              {.doc = "puts the middle of the shape's box at the origin"});
      break;
  }
  if (options.kind != PatternKind::svg) {
    describe_list(v, "holes", options.holes, {.doc = "polygons that are cut out of the pattern"});
  }
  describe_list(v, "cuts", options.cuts,
                {.doc = "lines along which the pattern is open from the start"});
}

void describe_plate(OptionVisitor& v, PaperMaterial& options) {
  v.value("thickness", options.thickness,
          {.doc = "thickness h of the paper", .unit = "m", .min = 1e-9, .max = 1});
  v.value("young_modulus", options.young_modulus,
          {.doc = "Young's modulus E of the paper", .unit = "Pa", .min = 1e-3, .max = kStiffest});
  v.value("poisson_ratio", options.poisson_ratio,
          {.doc = "Poisson's ratio nu of the paper", .min = 0, .max = 0.499});
  v.value("area_density", options.area_density,
          {.doc = "mass of an area of the paper", .unit = "kg/m^2", .min = 1e-9, .max = kHeaviest});
}

void describe(OptionVisitor& v, PaperMaterial& options) {
  describe_plate(v, options);
  v.value("yield_curvature", options.yield_curvature,
          {.doc = "elastic curvature beyond which the sheet creases",
           .unit = "1/m",
           .min = 1e-9,
           .max = kSharpest});
  v.value("weakening", options.weakening,
          {.doc = "weakening of bending by damage: its stiffness falls by 1 / (1 + weakening "
                  "* damage)",
           .min = 0,
           .max = kLargest});
  v.value("friction", options.friction,
          {.doc = "Coulomb friction of the sheet against obstacles", .min = 0, .max = kRoughest});
  v.value(
      "grain_deg", options.grain_deg,
      {.doc = "direction of the fibres that bend more stiffly, from u towards v", .unit = "deg"});
  v.value("along", options.along,
          {.doc = "bending stiffness along the fibres over that across them; needs grain_deg",
           .min = 1e-3,
           .max = 1e3});
  v.value("damping", options.damping,
          {.doc = "time of the damping that is proportional to stiffness (Rayleigh)",
           .unit = "s",
           .min = 0,
           .max = kSlowest});
}

void describe(OptionVisitor& v, IntervalOptions& options) {
  v.value("from", options.from,
          {.doc = "first time of an interval", .unit = "s", .required = true});
  v.value("to", options.to, {.doc = "last time of an interval", .unit = "s", .required = true});
}

void describe(OptionVisitor& v, DiscOptions& options) {
  v.value("u", options.u,
          {.doc = "first coordinate of the centre of a disc", .unit = "m", .required = true});
  v.value("v", options.v,
          {.doc = "second coordinate of the centre of a disc", .unit = "m", .required = true});
  v.value("radius", options.radius,
          {.doc = "radius of a disc that is held", .unit = "m", .min = 1e-9});
}

void describe(OptionVisitor& v, HandleOptions& options) {
  v.value("name", options.name, {.doc = "name of a handle, for messages"});
  describe_list(v, "points", options.points,
                {.doc = "points of the pattern that a handle holds; instead: segment or disc"});
  v.value("segment", options.segment,
          {.doc = "straight line of the pattern that a handle holds: u v of one end, u v of the "
                  "other; instead: points or disc",
           .unit = "m"});
  describe_group(v, "disc", options.disc,
                 {.doc = "disc of the pattern that a handle holds; instead: points or segment"});
  describe_keys(v, options.keys);
  v.value("stiffness", options.stiffness,
          {.doc = "stiffness of a hand that gives: what it holds departs from its place by the "
                  "force over this; absent: not at all",
           .unit = "N/m",
           .min = 1e-6,
           .max = 1e9});
  v.value(
      "force", options.force,
      {.doc = "dead load x y z of a handle, spread over its shape, instead of keys", .unit = "N"});
  describe_list(v, "active", options.active,
                {.doc = "times at which a handle holds or pulls; empty: always"});
}

void describe(OptionVisitor& v, RadiusKeyOptions& options) {
  v.value("t", options.t, {.doc = "time of a radius", .unit = "s", .required = true});
  v.value("radius", options.radius,
          {.doc = "radius of an obstacle at that time, linear between",
           .unit = "m",
           .min = 1e-9,
           .required = true});
}

void describe(OptionVisitor& v, ObstacleOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"plane", "sphere", "cylinder",
                                                          "hollow-sphere", "torus"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "plane: centre, axis (its normal); sphere, hollow-sphere (the sheet is "
                          "inside): centre, radius; cylinder: centre, axis, radius, half_length; "
                          "torus: centre, axis, radius, tube_radius"});
  v.value("name", options.name, {.doc = "name of an obstacle, for messages"});
  v.value("centre", options.centre, {.doc = "centre of an obstacle at the start", .unit = "m"});
  if (options.kind == Obstacle::Kind::plane || options.kind == Obstacle::Kind::cylinder ||
      options.kind == Obstacle::Kind::torus) {
    v.value("axis", options.axis,
            {.doc = "normal of a plane, axis of a cylinder or torus, of any length"});
  }
  if (options.kind != Obstacle::Kind::plane) {
    v.value("radius", options.radius,
            {.doc = "radius of a sphere or cylinder, or of the ring of a torus",
             .unit = "m",
             .min = 1e-9});
    describe_list(v, "radii", options.radii,
                  {.doc = "radius of an obstacle over time; empty: constant"});
  }
  if (options.kind == Obstacle::Kind::torus) {
    v.value("tube_radius", options.tube_radius,
            {.doc = "radius of the wire of a torus", .unit = "m", .min = 1e-9});
  }
  if (options.kind == Obstacle::Kind::cylinder) {
    v.value("half_length", options.half_length,
            {.doc = "half the length of a cylinder; 0: endless", .unit = "m", .min = 0});
  }
  describe_keys(v, options.keys);
}

}  // namespace geoprior::paper
