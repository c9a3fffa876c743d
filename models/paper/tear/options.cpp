#include "models/paper/tear/options.h"

#include <array>
#include <string_view>

namespace geoprior::paper {

void describe(OptionVisitor& v, TearOptions& o) {
  static constexpr std::array<std::string_view, 2> kSearches{"candidates", "everywhere"};
  static constexpr std::array<std::string_view, 3> kReleases{"j-integral", "resultants", "force"};
  static constexpr std::array<std::string_view, 2> kIntegrators{"euler", "midpoint"};
  static constexpr std::array<std::string_view, 3> kDirections{"steepest", "bisector", "askew"};
  describe_group(v, "pull", o.pull, {.doc = "how the forces about the tip of a tear are gathered"});
  v.value("flaw", o.flaw,
          {.doc = "length of the flaws from which smooth places tear: junctions of cones at the "
                  "border, and every vertex with search = everywhere",
           .unit = "m",
           .min = 1e-9,
           .max = 10});
  v.value("step", o.step,
          {.doc = "length by which a tear grows in one step", .unit = "m", .min = 1e-9, .max = 10});
  describe_choice(v, "search", o.search, kSearches,
                  {.doc = "where the sheet may tear: at the candidates of the thesis, or at every "
                          "vertex of the mesh"});
  describe_choice(v, "release", o.release, kReleases,
                  {.doc = "energy that a tear sets free: the J integral, 2 F cos(theta / 2) / e of "
                          "the two resultants, or (a null) 2 F / e"});
  describe_choice(v, "integrator", o.integrator, kIntegrators,
                  {.doc = "direction of a step: that at its start (euler), or that in its middle, "
                          "extrapolated (midpoint)"});
  describe_choice(v, "direction", o.direction, kDirections,
                  {.doc = "where a tear goes: where most is released of what is opposed, along the "
                          "bisector of the pulls, or (a null) 45 degrees from it"});
  v.value("most_turn_deg", o.most_turn_deg,
          {.doc = "largest angle by which a tear turns from one step to the next",
           .unit = "deg",
           .min = 0,
           .max = 180});
  v.value("rest_steps", o.rest_steps,
          {.doc = "most implicit steps in which a pull may come to rest before its tear grows",
           .min = 1,
           .max = 1000});
  v.value("rest_turn_deg", o.rest_turn_deg,
          {.doc = "largest turn of a pull at rest from one implicit step to the next",
           .unit = "deg",
           .min = 0,
           .max = 180});
  v.value("rest_change", o.rest_change,
          {.doc = "largest relative change of the release of a pull at rest from one implicit step "
                  "to the next",
           .min = 0,
           .max = 1e9});
  v.value("least_part", o.least_part,
          {.doc = "smallest area that a tear may cut off", .unit = "m^2", .min = 0, .max = 1});
  describe_group(v, "detail", o.detail,
                 {.doc = "noise, fibres and a bevel along the lips of tears: parts of the frame, "
                         "of which the mesh knows nothing"});
}

}  // namespace geoprior::paper
