#include "solvers/fluid/tracking/options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {
namespace {

constexpr std::array<std::string_view, 3> kAssignmentNames{"flow", "frame-by-frame", "greedy"};

}  // namespace

void describe(OptionVisitor& v, TrackingOptions& o) {
  describe_choice(v, "assignment", o.assignment, kAssignmentNames,
                  {.doc = "solver of the path cover: all frames at once, best assignment frame by "
                          "frame, nearest first"});
  v.value("largest_gap", o.largest_gap,
          {.doc = "frames that a link may span", .min = 1, .max = 100});
  v.value("sigma_centre", o.sigma_centre,
          {.doc = "deviation of a centre from where it is predicted",
           .unit = "h",
           .min = 1e-3,
           .max = 1e3});
  v.value("sigma_size", o.sigma_size,
          {.doc = "share of the square root of a region's area by which its centre deviates too",
           .min = 0,
           .max = 10});
  v.value("sigma_area", o.sigma_area,
          {.doc = "deviation of the logarithm of the ratio of areas", .min = 1e-3, .max = 1e3});
  v.value("sigma_volume", o.sigma_volume,
          {.doc = "deviation of the logarithm of the ratio of volumes, of isolated features",
           .min = 1e-3,
           .max = 1e3});
  v.value("new_path_cost", o.new_path_cost,
          {.doc = "cost c_new of a path, a chi-squared value", .min = 0, .max = 1e6});
  v.value("gap_cost", o.gap_cost,
          {.doc = "cost of each frame that a link skips", .min = 0, .max = 1e6});
  v.value("largest_speed", o.largest_speed,
          {.doc = "largest speed of a link; absent: any, and the spread of unknown motions is from "
                  "the data",
           .unit = "m/s",
           .min = 0,
           .max = 1e6});
  v.value("ballistic", o.ballistic, {.doc = "predicts isolated features with gravity"});
  v.value("gravity", o.gravity,
          {.doc = "acceleration of isolated features in flight", .unit = "m/s^2"});
}

}  // namespace geoprior::fluid
