#pragma once

#include "solvers/sketch/layers/layered_body.h"

namespace geoprior::sketch {

/// Two neighbouring layers at rest.
struct LayerJoint {
  const FrustumBand& front;
  const FrustumBand& behind;
  const LayerHinge& hinge;
  double overlap = 0;  ///< m
};

/// Whether an angle (rad) and half of it are free both ways, in the sense of `set_joint_limits`.
bool joint_turns(const LayerJoint& joint, double angle, const LayerOptions& options, double unit);

/// Sets the largest angles by which each hinge can be turned, curling up and stretching out.
///
/// An angle is free when the two layers as solids do not touch (an edge of one that meets a
/// triangle of the other, both ways, by trees of boxes) and, with `keep_covered`, when every
/// point of the front layer's rear rim that is inside of the rivets lies a tenth of the overlap or
/// more behind the other's front rim, so that no gap opens, and as much ahead of its rear rim
/// (closed form). Angles are tried in steps of one degree from rest, and the step in which
/// the first one is not free is bisected; a hundredth of a degree is taken off. A joint that is not
/// free at rest has no range.
///
/// Layers that are not neighbours are compared in the two extreme poses of the whole body; all
/// angles that way are made smaller, by a tenth at a time, until none touch.
///
/// Hinges are independent and computed in parallel.
void set_joint_limits(ArticulatedLayers& layers, const LayerOptions& options);

}  // namespace geoprior::sketch
