#pragma once

#include "core/options.h"
#include "experiments/sketch/truth/synthetic_views.h"

namespace geoprior::sketch {

/// A body of rigid layers whose drawing is known with its depth: circles across the mirror plane,
/// their centres along an arc of a circle in it.
struct SyntheticLayerOptions {
  int arcs = 8;                 ///< one more than layers
  double radius = 1;            ///< of the widest circle, in the middle (m)
  double end_radius = 0.6;      ///< of the first and the last; a parabola between (m)
  double length = 2.4;          ///< of the line of centres (m)
  double bend_deg = 60;         ///< by how much it turns from the first circle to the last
  double half_angle_deg = 105;  ///< of every arc
  double hidden_deg = 60;       ///< of every arc, at the far end, is not drawn
  double yaw_deg = 40;          ///< of the mirror plane's normal from the direction of the eye
  double pitch_deg = 25;        ///< of the eye above the horizon
  int points = 60;              ///< drawn on an arc
  double noise = 0;             ///< standard deviation of drawn points, of the length
  int seed = 1;
};
void describe(OptionVisitor& v, SyntheticLayerOptions& options);

/// Orthographic drawing of the body: its arcs from head to tail, and the vectors of the mirror
/// plane from the first centre, without noise. The first two circles have one axis, as the two
/// edges of a frustum have. `height` is the length of the line of centres, `axis` that of the first
/// circle.
///
/// Each arc has random numbers of its own.
/// @throws Error  when less than 20 degrees of the arcs are drawn
SyntheticView synthetic_layers(const SyntheticLayerOptions& options);

}  // namespace geoprior::sketch
