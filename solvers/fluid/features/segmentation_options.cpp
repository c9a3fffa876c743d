#include "solvers/fluid/features/segmentation_options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {
namespace {

constexpr std::array<std::string_view, 2> kThresholdNames{"automatic", "given"};

void describe_thresholds(OptionVisitor& v, SegmentationOptions& o) {
  describe_choice(
      v, "thresholds", o.thresholds, kThresholdNames,
      {.doc =
           "where the thresholds come from: the calm frames of the sequence, or `high` and `low`"});
  v.value("high", o.high,
          {.doc = "least |H| h of the vertices that seed regions, with thresholds given",
           .min = 0,
           .max = 100});
  v.value("low", o.low,
          {.doc = "least |H| h of the vertices that regions grow through, with thresholds given",
           .min = 0,
           .max = 100});
  v.value(
      "noise_factor", o.noise_factor,
      {.doc = "MADs of |H| h on the calm surface from its median to the automatic low threshold",
       .min = 0,
       .max = 100});
  v.value("seed_factor", o.seed_factor,
          {.doc = "ratio of the automatic high threshold to the low one", .min = 1, .max = 100});
}

}  // namespace

void describe(OptionVisitor& v, SegmentationOptions& o) {
  describe_group(v, "curvature", o.curvature, {.doc = "estimate of the mean curvature H"});
  describe_group(v, "mask", o.mask,
                 {.doc = "walls and solids, beside which nothing is looked for"});
  v.value("cell", o.cell,
          {.doc = "length h in which others are given; absent: mean edge of the first frame with "
                  "triangles",
           .unit = "m",
           .min = 1e-9,
           .max = 1e9});
  describe_thresholds(v, o);
  v.value("smallest_area", o.smallest_area,
          {.doc = "area below which regions are dropped", .unit = "h^2", .min = 0, .max = 1e9});
  v.value(
      "close_radius", o.close_radius,
      {.doc = "radius of the closing: dilation, then erosion", .unit = "h", .min = 0, .max = 1000});
  v.value(
      "open_radius", o.open_radius,
      {.doc = "radius of the opening: erosion, then dilation", .unit = "h", .min = 0, .max = 1000});
  v.value("largest_hole", o.largest_hole,
          {.doc = "area up to which holes of a region are filled",
           .unit = "h^2",
           .min = 0,
           .max = 1e9});
  v.value("largest_drop", o.largest_drop,
          {.doc = "largest isolated component, as a share of the largest one's volume (of its area "
                  "if that is open)",
           .min = 0,
           .max = 1});
}

}  // namespace geoprior::fluid
