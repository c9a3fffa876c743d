#pragma once

#include <optional>

#include "core/options.h"
#include "experiments/sketch/truth/synthetic_views.h"

namespace geoprior::sketch {

/// A body of rigid layers whose drawing is known with its depth: circles across the mirror plane,
/// their centres along an arc of a circle in it.
struct SyntheticLayerOptions {
  int arcs = 8;
  double radius = 1;
  double end_radius = 0.6;                 ///< of the first and the last; a parabola between (m)
  std::optional<double> rear_radius = {};  ///< of the last, where it differs (m)
  double length = 2.4;
  double bend_deg = 60;
  double first_tilt_deg = 0;
  double half_angle_deg = 105;
  double hidden_deg = 60;
  double yaw_deg = 40;
  double pitch_deg = 25;
  int points = 60;
  double noise = 0;
  int seed = 1;
};
void describe(OptionVisitor& v, SyntheticLayerOptions& options);

/// Orthographic drawing of the body: its arcs from head to tail, and the vectors of the mirror
/// plane from the first centre, without noise. The first two circles have one axis, as the two
/// edges of a frustum have, but for `first_tilt_deg`. `height` is the length of the line of
/// centres, `axis` that of the first circle.
///
/// Each arc has random numbers of its own.
/// @throws Error  when less than 20 degrees of the arcs are drawn
SyntheticView synthetic_layers(const SyntheticLayerOptions& options);

}  // namespace geoprior::sketch
