#include <array>
#include <string_view>

#include "experiments/details/pattern.h"

namespace geoprior {

void describe(OptionVisitor& v, DensityOptions& options) {
  static constexpr std::array<std::string_view, 3> kKinds{"constant", "gradient", "array"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "constant; gradient: axis, from, to; array: array"});
  if (options.kind == DensityKind::gradient) {
    v.value("axis", options.axis, {.doc = "along which it changes, any length"});
    v.value("from", options.from, {.doc = "at the lower end of the surface", .min = 0});
    v.value("to", options.to, {.doc = "at the upper end, linear between", .min = 0});
  }
  if (options.kind == DensityKind::array) {
    v.value("array", options.array,
            {.doc = "array of the points of the surface's .vtp, not negative", .required = true});
  }
}

void describe(OptionVisitor& v, RegionOptions& options) {
  static constexpr std::array<std::string_view, 3> kKinds{"half-space", "ball", "facing"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "half-space: point, direction (into it); ball: point, radius; facing: "
                          "direction, angle_deg of normals to it"});
  if (options.kind != RegionKind::facing) {
    v.value("point", options.point, {.doc = "of the plane, or centre", .unit = "m"});
  }
  if (options.kind != RegionKind::ball) {
    v.value("direction", options.direction, {.doc = "of any length"});
  } else {
    v.value("radius", options.radius, {.doc = "of the ball", .unit = "m", .min = 1e-9});
  }
  if (options.kind == RegionKind::facing) {
    v.value("angle_deg", options.angle_deg,
            {.doc = "largest angle of a normal", .unit = "deg", .min = 0, .max = 180});
  }
  v.value("outside", options.outside, {.doc = "true: where the condition does not hold"});
}

void describe(OptionVisitor& v, DetailPatternOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"poisson-disk", "grid", "uniform",
                                                          "clusters", "file"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "poisson-disk: radius; grid: jitter (planes); uniform: independent of "
                          "each other; clusters: cluster_size, cluster_radius; file: file"});
  if (options.kind == PatternKind::file) {
    v.value("file", options.file,
            {.doc = "positions: .csv with the columns x, y, z and, if need be, weight, type; or "
                    "the vertices of a mesh file",
             .required = true});
    v.value("max_distance", options.max_distance,
            {.doc = "of a position from the surface; absent: a hundredth of its size",
             .unit = "m",
             .min = 0});
  } else {
    v.value("count", options.count, {.doc = "details asked for", .min = 3, .max = 2000000});
    describe_group(v, "density", options.density, {.doc = "details per area, relative"});
    describe_list(v, "region", options.region,
                  {.doc = "conditions that must all hold where there are details"});
    v.value("types", options.types, {.doc = "kinds of details, drawn at random", .min = 1});
  }
  if (options.kind == PatternKind::poisson_disk || options.kind == PatternKind::clusters) {
    v.value("radius", options.radius,
            {.doc = "smallest distance x sqrt(density), of details or of centres of clusters",
             .min = 0,
             .max = 1});
  }
  if (options.kind == PatternKind::grid) {
    v.value("jitter", options.jitter, {.doc = "range of the shift / spacing", .min = 0, .max = 1});
  }
  if (options.kind == PatternKind::clusters) {
    v.value("cluster_size", options.cluster_size,
            {.doc = "details of a cluster", .min = 2, .max = 20});
    v.value("cluster_radius", options.cluster_radius,
            {.doc = "of a cluster / spacing of the centres", .min = 0.01, .max = 0.5});
  }
  v.value("aligned", options.aligned, {.doc = "tangents along `direction`, else at random"});
  v.value("direction", options.direction, {.doc = "of aligned tangents"});
  v.value("seed", options.seed, {.doc = "of places, types and tangents", .min = 0});
}

}  // namespace geoprior
