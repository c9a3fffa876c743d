#include "solvers/fluid/features/segmentation_options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {
namespace {

constexpr std::array<std::string_view, 2> kThresholdNames{"automatic", "given"};

void describe_thresholds(OptionVisitor& v, SegmentationOptions& o) {
  describe_choice(v, "thresholds", o.thresholds, kThresholdNames,
                  {.doc = "from the calm frames of the sequence, or `high` and `low`"});
  v.value("high", o.high, {.doc = "seeds: |H| h above this (given)", .min = 0, .max = 100});
  v.value("low", o.low, {.doc = "grown through |H| h above this (given)", .min = 0, .max = 100});
  v.value("noise_factor", o.noise_factor,
          {.doc = "automatic: low = median + this * MAD of |H| h on the calm free surface",
           .min = 0,
           .max = 100});
  v.value("seed_factor", o.seed_factor,
          {.doc = "automatic: high = this * low", .min = 1, .max = 100});
}

}  // namespace

void describe(OptionVisitor& v, SegmentationOptions& o) {
  describe_group(v, "curvature", o.curvature, {.doc = "estimate of the mean curvature H"});
  describe_group(v, "mask", o.mask, {.doc = "walls and solids"});
  v.value("cell", o.cell,
          {.doc = "h, unit of the lengths below; default: mean edge of the first frame that has "
                  "triangles",
           .unit = "m",
           .min = 1e-9,
           .max = 1e9});
  describe_thresholds(v, o);
  v.value("smallest_area", o.smallest_area,
          {.doc = "regions below this are dropped", .unit = "h^2", .min = 0, .max = 1e9});
  v.value("close_radius", o.close_radius,
          {.doc = "dilation, then erosion by this", .unit = "h", .min = 0, .max = 1000});
  v.value("open_radius", o.open_radius,
          {.doc = "erosion, then dilation by this", .unit = "h", .min = 0, .max = 1000});
  v.value("largest_hole", o.largest_hole,
          {.doc = "holes of a region up to this are filled", .unit = "h^2", .min = 0, .max = 1e9});
  v.value("largest_drop", o.largest_drop,
          {.doc = "isolated components have at most this share of the largest one's volume (beside "
                  "an open surface: of its area)",
           .min = 0,
           .max = 1});
  v.value("handles", o.handles, {.doc = "isolated components may have handles (torn crowns)"});
}

}  // namespace geoprior::fluid
