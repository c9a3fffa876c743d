#pragma once

#include <array>
#include <optional>

#include "core/options.h"

namespace geoprior::fluid {

enum class AssignmentKind { flow, frame_by_frame, greedy };

struct TrackingOptions {
  AssignmentKind assignment = AssignmentKind::flow;
  int largest_gap = 3;
  double sigma_centre = 2;
  double sigma_size = 0.1;
  double sigma_area = 0.5;
  double sigma_volume = 0.3;
  double new_path_cost = 10;
  double gap_cost = 1;
  std::optional<double> largest_speed;
  bool ballistic = true;
  std::array<double, 3> gravity{0, 0, -9.81};
};
void describe(OptionVisitor& v, TrackingOptions& options);

}  // namespace geoprior::fluid
