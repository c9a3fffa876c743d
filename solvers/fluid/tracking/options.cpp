#include "solvers/fluid/tracking/options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {
namespace {

constexpr std::array<std::string_view, 3> kAssignmentNames{"flow", "frame-by-frame", "greedy"};

}  // namespace

void describe(OptionVisitor& v, TrackingOptions& o) {
  describe_choice(v, "assignment", o.assignment, kAssignmentNames,
                  {.doc = "path cover of all frames at once (a flow), best assignment frame by "
                          "frame, or nearest first"});
  v.value("largest_gap", o.largest_gap,
          {.doc = "frames that a link may span", .min = 1, .max = 100});
  v.value("sigma_centre", o.sigma_centre,
          {.doc = "of the centre's distance from its prediction",
           .unit = "h",
           .min = 1e-3,
           .max = 1e3});
  v.value("sigma_size", o.sigma_size,
          {.doc = "added to it: this share of the square root of the area", .min = 0, .max = 10});
  v.value("sigma_area", o.sigma_area, {.doc = "of ln(area ratio)", .min = 1e-3, .max = 1e3});
  v.value("sigma_volume", o.sigma_volume,
          {.doc = "of ln(volume ratio), isolated features", .min = 1e-3, .max = 1e3});
  v.value("new_path_cost", o.new_path_cost,
          {.doc = "c_new, a chi-squared value", .min = 0, .max = 1e6});
  v.value("gap_cost", o.gap_cost, {.doc = "for each frame skipped", .min = 0, .max = 1e6});
  v.value("largest_speed", o.largest_speed,
          {.doc = "of links; default: none, and the spread of unknown motions is from the data",
           .unit = "m/s",
           .min = 0,
           .max = 1e6});
  v.value("ballistic", o.ballistic, {.doc = "isolated features are predicted with gravity"});
  v.value("gravity", o.gravity, {.doc = "gravity", .unit = "m/s^2"});
  v.value("overlap_for_event", o.overlap_for_event,
          {.doc = "share of overlap that makes a split or merge", .min = 0, .max = 1});
  v.value("cause_delay", o.cause_delay,
          {.doc = "a drop causes waves that begin at most this long after its end",
           .unit = "s",
           .min = 0,
           .max = 1e3});
  v.value(
      "cause_reach", o.cause_reach,
      {.doc = "and at most this far from it, beside its size", .unit = "h", .min = 0, .max = 1e3});
}

}  // namespace geoprior::fluid
