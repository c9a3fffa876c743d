#include <array>
#include <string_view>

#include "solvers/details/replication.h"

namespace geoprior {

void describe(OptionVisitor& v, TripletOptions& options) {
  v.value("radius", options.radius,
          {.doc = "R: largest edge of a triplet in mean edges of M_d", .min = 1, .max = 10});
  v.value("all", options.all,
          {.doc = "all triplets whatever their size, as the thesis says (at most 400 details)"});
  v.value("interior_only", options.interior_only,
          {.doc = "only triplets with a detail strictly inside"});
  v.value("cells", options.cells, {.doc = "of the grid along either key", .min = 4, .max = 1024});
  v.value("cell_capacity", options.cell_capacity,
          {.doc = "triplets kept in a cell", .min = 1, .max = 1024});
  v.value("max_sources", options.max_sources,
          {.doc = "details whose surroundings are searched for triplets", .min = 1});
  v.value("interior_capacity", options.interior_capacity,
          {.doc = "most details inside a triplet", .min = 1, .max = 64});
}

void describe(OptionVisitor& v, PairCorrelationOptions& options) {
  v.value("radius", options.radius,
          {.doc = "largest distance in mean edges of M_d", .min = 0.5, .max = 10});
  v.value("bins", options.bins, {.doc = "of the distance", .min = 2, .max = 512});
  v.value("bandwidth", options.bandwidth,
          {.doc = "sigma of the Gaussian kernel in mean edges", .min = 0.01, .max = 1});
}

void describe(OptionVisitor& v, ReplicationOptions& options) {
  static constexpr std::array<std::string_view, 3> kAreaRules{"own", "mean", "budget"};
  static constexpr std::array<std::string_view, 2> kWeightLaws{"frame", "motion"};
  static constexpr std::array<std::string_view, 2> kLengths{"chord", "geodesic"};
  describe_choice(v, "area_rule", options.area_rule, kAreaRules,
                  {.doc = "reference area of a triangle: its own, the mean, or a local budget"});
  v.value("stretch_threshold", options.stretch_threshold,
          {.doc = "tau: a triangle is filled above this factor (own, mean)", .min = 1.01});
  v.value(
      "shrink_threshold", options.shrink_threshold,
      {.doc = "tau_c: a triangle loses a detail below 1 / this factor (own, mean)", .min = 1.01});
  v.value("patch_details", options.patch_details,
          {.doc = "budget: details of a patch at rest", .min = 1});
  v.value("dead_band", options.dead_band,
          {.doc = "budget: a patch acts when off by more than 1/2 + this", .min = 0, .max = 10});
  v.value(
      "anticipate", options.anticipate,
      {.doc = "budget: patches ask for what they need K / 4 frames ahead when they grow, 3 K / 4 "
              "when they shrink, K = 1 / weight_rate"});
  v.value("max_insertions", options.max_insertions,
          {.doc = "most details inserted in a frame; absent: no limit", .min = 1});
  describe_choice(v, "weight_law", options.weight_law, kWeightLaws,
                  {.doc = "weights change per frame, or per amount of motion"});
  v.value("weight_rate", options.weight_rate,
          {.doc = "largest change of a weight in a frame", .min = 1e-3, .max = 1});
  v.value("motion_rate", options.motion_rate,
          {.doc = "law motion: change of weight per mean edge of displacement", .min = 0});
  describe_choice(v, "lengths", options.lengths, kLengths,
                  {.doc = "edges of M_d: distance of their ends, or along the surface"});
  v.value("histogram", options.histogram,
          {.doc = "choose among candidate triplets by the pair correlation (the extension)"});
  v.value("candidates", options.candidates,
          {.doc = "m: triplets that the extension compares", .min = 1, .max = 64});
  describe_group(v, "triplets", options.triplets, {.doc = "the table of triplets T"});
  describe_group(v, "pair_correlation", options.pair_correlation,
                 {.doc = "the histogram of the extension"});
}

}  // namespace geoprior
