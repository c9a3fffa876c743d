#include "solvers/paper/hybrid_options.h"

#include <array>
#include <string_view>

namespace geoprior::paper {
namespace {

constexpr std::array<std::string_view, 2> kTestNames{"euler", "threshold"};

void describe_compression(OptionVisitor& v, HybridOptions& o) {
  describe_choice(v, "test", o.test, kTestNames,
                  {.doc = "what compression is compared with: the strain at which the sheet "
                          "buckles (euler), or a plain threshold"});
  v.value("euler_factor", o.euler_factor,
          {.doc = "compression over the buckling strain beyond which rulings start",
           .min = 1e-6,
           .max = 1e9});
  v.value("least_slope_deg", o.least_slope_deg,
          {.doc = "slope of the buckled shape under which compression is let be (Euler's test)",
           .unit = "deg",
           .min = 0,
           .max = 45});
  v.value("compression_threshold", o.compression_threshold,
          {.doc = "largest admissible compression eps_c of the plain test", .min = 1e-9, .max = 1});
  v.value("group_angle_deg", o.group_angle_deg,
          {.doc = "largest angle between directions of neighbours that belong to one group",
           .unit = "deg",
           .min = 1,
           .max = 45});
}

void describe_rulings(OptionVisitor& v, HybridOptions& o) {
  v.value("seeding_distance", o.seeding_distance,
          {.doc = "distance s of parallel rulings", .unit = "m", .min = 1e-4, .max = 10});
  v.value("flat_size", o.flat_size,
          {.doc = "largest edge of the mesh where nothing is bent yet",
           .unit = "m",
           .min = 1e-3,
           .max = 100});
  v.value("refinements", o.refinements,
          {.doc = "most halvings of edges where the sheet strains whatever its rulings are; 0: the "
                  "mesh stays coarse",
           .min = 0,
           .max = 6});
  v.value("ruling_parts", o.ruling_parts,
          {.doc = "most edges along a ruling; with 1 it cannot bend, and only compression makes "
                  "singular points",
           .min = 1,
           .max = 100});
  v.value("merge_angle_deg", o.merge_angle_deg,
          {.doc = "angle between neighbouring cylinders under which they become one",
           .unit = "deg",
           .min = 0,
           .max = 45});
  v.value("singular_spacing", o.singular_spacing,
          {.doc = "smallest distance of singular points, in seeding distances",
           .min = 0.5,
           .max = 100});
  v.value(
      "settle_frames", o.settle_frames,
      {.doc = "age from which a ruling that a candidate crosses makes a singular point, in frames",
       .min = 0,
       .max = 1e6});
  v.value("cone_reach", o.cone_reach,
          {.doc = "farthest that a new singular point cuts rulings, in seeding distances",
           .min = 1,
           .max = 1000});
  v.value("flatten_angle_deg", o.flatten_angle_deg,
          {.doc = "largest angle by which the rulings that a new singular point cuts on one side "
                  "turn the sheet",
           .unit = "deg",
           .min = 0,
           .max = 360});
  v.value(
      "fan_angle_deg", o.fan_angle_deg,
      {.doc = "widest sector of a new cone without a ruling", .unit = "deg", .min = 10, .max = 90});
  v.value("refine_angle_deg", o.refine_angle_deg,
          {.doc = "fold of a ruling beside which another one is put",
           .unit = "deg",
           .min = 2,
           .max = 180});
}

void describe_looks(OptionVisitor& v, HybridOptions& o) {
  v.value("look_frames", o.look_frames,
          {.doc = "frames from one look at rulings to the next, unless the sheet strains",
           .min = 1,
           .max = 1000});
  v.value(
      "jump_share", o.jump_share,
      {.doc = "farthest that a change of the mesh may move the sheet, in the way that its fastest "
              "vertex goes between two looks or in 0.625 seeding distances, if that is shorter",
       .min = 0,
       .max = 1e6});
}

void describe_tracking(OptionVisitor& v, HybridOptions& o) {
  v.value("energy_test", o.energy_test,
          {.doc = "singular points are made, and stay, only where the sheet has less energy with "
                  "them; without the test compression alone makes them, for ever"});
  v.value("tracking", o.tracking, {.doc = "rulings follow the bending of the simulated sheet"});
  v.value("guide_edge", o.guide_edge,
          {.doc = "edge length of the even mesh that shows how the sheet would bend; shorter on a "
                  "narrow band",
           .unit = "m",
           .min = 1e-3,
           .max = 10});
  v.value("follow_angle_deg", o.follow_angle_deg,
          {.doc = "largest angle of a ruling to the direction of least bending",
           .unit = "deg",
           .min = 1,
           .max = 45});
  v.value("tracking_rate_deg", o.tracking_rate_deg,
          {.doc = "largest angle by which a ruling turns in a frame",
           .unit = "deg",
           .min = 0,
           .max = 45});
  v.value("flat_curvature", o.flat_curvature,
          {.doc = "curvature kappa_0 under which a piece counts as flat",
           .unit = "1/m",
           .min = 0,
           .max = 1e4});
  v.value("flat_frames", o.flat_frames,
          {.doc = "frames for which a piece without singular point has been flat when it goes",
           .min = 1,
           .max = 1e6});
  v.value("projection", o.projection,
          {.doc = "projects the sheet to an isometry at the end of every frame"});
  v.value("projection_iterations", o.projection_iterations,
          {.doc = "most linear solves of an isometry projection", .min = 1, .max = 100});
  v.value("projection_strain", o.projection_strain,
          {.doc = "edge strain at which an isometry projection ends", .min = 1e-12, .max = 0.1});
  v.value("accepted_strain", o.accepted_strain,
          {.doc = "principal strain after the projection beyond which a change of the structure is "
                  "taken back",
           .min = 1e-9,
           .max = 1});
  v.value(
      "attempts", o.attempts,
      {.doc = "draws of singular points in a frame that is strained with and without its change",
       .min = 1,
       .max = 1000});
  v.value(
      "last_iterations", o.last_iterations,
      {.doc = "linear solves of the projection in such a last attempt, in those of a usual frame",
       .min = 1,
       .max = 1000});
  v.value("weakening_radius", o.weakening_radius,
          {.doc = "radius r_p about a singular point within which the sheet yields",
           .unit = "m",
           .min = 0,
           .max = 1});
}

}  // namespace

void describe(OptionVisitor& v, HybridOptions& o) {
  describe_compression(v, o);
  describe_rulings(v, o);
  describe_tracking(v, o);
  describe_looks(v, o);
  describe_group(v, "settle", o.settle,
                 {.doc = "how the sheet comes to rest after every new mesh"});
  describe_group(v, "tearing", o.tearing, {.doc = "how tears grow in scenes whose paper tears"});
  describe_group(v, "stepper", o.stepper, {.doc = "how the sheet is stepped in time"});
}

}  // namespace geoprior::paper
