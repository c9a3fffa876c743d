#pragma once

#include <array>

#include "core/inputs/rig.h"
#include "core/options.h"

namespace geoprior {

/// A closed tube about the x axis, bent or twisted at the origin; lengths in metres.
struct CylinderOptions {
  double radius = 0.1;
  double half_length = 0.5;
  double cap_height = 0.1;  ///< half axis of an ellipse
  int segments = 48;
  int rings_per_half = 40;  ///< one more lies at x = 0
  double ramp_width = 0.2;
};
void describe(OptionVisitor& v, CylinderOptions& options);

/// Two-bone cylinder with analytic weights.
///
/// Joints "lower" (root, head at x = -half_length, bone to the origin) and "upper" (head at the
/// origin, bone to x = +half_length), axes "flexion" = +y (carries +x towards -z), "twist" = +x and
/// "abduction" = +z. The weight of "upper" is clamp(1/2 + x / ramp_width, 0, 1): linear, and
/// exactly 1/2 at the ring x = 0. The surface is closed, of genus 0, outward oriented.
///
/// Its skinned mid-ring has a closed form: see `LinearBlend`.
/// @throws Error  for a length that is not positive, fewer than 3 segments or no rings
RiggedMesh two_bone_cylinder(const CylinderOptions& options = {});

/// Indices of the vertices of the ring x = 0 of `two_bone_cylinder(options)`, in order of angle
/// from +y to +z.
std::vector<int> mid_ring(const CylinderOptions& options);

/// A straight finger of three phalanges on a stump of the hand, about the x axis; lengths in
/// metres.
struct FingerOptions {
  double hand_length = 0.03;  ///< before x = 0
  std::array<double, 3> phalanx_length{0.04, 0.025, 0.02};
  std::array<double, 4> radius{0.010, 0.009, 0.0082, 0.0074};  ///< the last of a half sphere
  int segments = 40;
  double ramp_width = 1.0;
  double ring_spacing = 1.0;
};
void describe(OptionVisitor& v, FingerOptions& options);

/// Finger whose rest surface is the union of tapered capsules with collinear axes: one closed
/// manifold surface of revolution.
///
/// Joints "hand" (root), "proximal", "middle", "distal", each with its bone along +x and axes
/// "flexion" = +y (carries the tip towards -z, the palm's side), "twist" = +x, "abduction" = +z.
/// Weights are products of smooth steps (3t^2 - 2t^3) about the joints, C1 along the finger.
/// @throws Error  for a length or radius that is not positive or fewer than 3 segments
RiggedMesh capsule_finger(const FingerOptions& options = {});

}  // namespace geoprior
