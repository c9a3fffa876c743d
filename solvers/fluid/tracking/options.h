#pragma once

#include <array>
#include <optional>

#include "core/options.h"

namespace geoprior::fluid {

enum class AssignmentKind { flow, frame_by_frame, greedy };

struct TrackingOptions {
  AssignmentKind assignment = AssignmentKind::flow;
  int largest_gap = 3;        ///< frames a link may span (1: consecutive ones only)
  double sigma_centre = 2;    ///< of the centre's distance from its prediction (h)
  double sigma_size = 0.1;    ///< … and this share of sqrt(area): large regions change shape
  double sigma_area = 0.5;    ///< of ln(area ratio)
  double sigma_volume = 0.3;  ///< of ln(volume ratio), isolated only
  double new_path_cost = 10;  ///< c_new, a chi-squared value
  double gap_cost = 1;        ///< added for each frame skipped
  std::optional<double>
      largest_speed;      ///< gate of links (m/s); default: motions' spread from the data
  bool ballistic = true;  ///< isolated regions are predicted with gravity
  std::array<double, 3> gravity{0, 0, -9.81};
  double overlap_for_event = 0.3;  ///< share of overlap that makes a split or merge
  double cause_delay = 0.25;  ///< "causes": a wave begins at most this long after a drop ends (s)
  double cause_reach = 6;     ///< … and at most this far from it, beside the drop's size (h)
};
void describe(OptionVisitor& v, TrackingOptions& options);

}  // namespace geoprior::fluid
