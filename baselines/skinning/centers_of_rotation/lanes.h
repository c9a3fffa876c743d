#pragma once

#include <array>

#include "baselines/skinning/dual_quaternion/lanes.h"
#include "baselines/skinning/linear_blend/lanes.h"

// Blending about centers of rotation, four vertices at a time: what blend_about_centers() writes
// out for one.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function here is inlined: no ABI is crossed

namespace geoprior::skinning::lanes {

/// Upper three rows of a transform and the quaternion (x, y, z, w) of its rotation: two cache
/// lines.
struct alignas(128) TurningJoint {
  std::array<double, 12> row;
  std::array<double, 4> real;
};

/// Blended quaternions of four vertices (not of unit length), component by component.
[[gnu::always_inline]] inline Four blend_rotations(const TurningJoint* table, const Block& block) {
  const Four pivot = real_parts(table, block.joints);
  Four sum{all(0), all(0), all(0), all(0)};
  add(sum, first_weight(block), pivot);
  for (int s = 1; s < block.slots; ++s) {
    const Four q = real_parts(table, block.joints + 4 * s);
    add(sum, signed_weights(load(block.weights + 4 * (s - 1)), pivot, q), q);
  }
  transpose(sum.x, sum.y, sum.z, sum.w);
  return sum;
}

/// Adds four vectors, turned by quaternions r of any length: a + 2 / |r|^2 r x (r x a + s a).
[[gnu::always_inline]] inline void add_turned(const Four& r, const double* arms, Double4& x,
                                              Double4& y, Double4& z) {
  const Double4 ax = load(arms), ay = load(arms + 4), az = load(arms + 8);
  const Double4 factor = 2.0 / (r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  const Double4 cx = (r.y * az - r.z * ay) + r.w * ax;
  const Double4 cy = (r.z * ax - r.x * az) + r.w * ay;
  const Double4 cz = (r.x * ay - r.y * ax) + r.w * az;
  x += ax + factor * (r.y * cz - r.z * cy);
  y += ay + factor * (r.z * cx - r.x * cz);
  z += az + factor * (r.x * cy - r.y * cx);
}

}  // namespace geoprior::skinning::lanes

#pragma GCC diagnostic pop
