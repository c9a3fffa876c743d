#pragma once

#include <array>
#include <cstdint>

#include "baselines/skinning/shared/lanes.h"

// Dual quaternion blending of four vertices at a time: what dual_quaternion_blend() writes out for
// one.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function here is inlined: no ABI is crossed

namespace geoprior::skinning::lanes {

/// Unit dual quaternion, coefficients in the order x, y, z, w.
struct alignas(32) DualQuaternion {
  std::array<double, 4> real;
  std::array<double, 4> dual;
};

/// Four quaternions: one a member before the transposition in `blend`, one component of all four a
/// member after it.
struct Four {
  Double4 x, y, z, w;
};

/// A `Joint` has `real`, as DualQuaternion.
template <class Joint>
[[gnu::always_inline]] inline Four real_parts(const Joint* table, const std::uint16_t* joint) {
  return {load(table[joint[0]].real.data()), load(table[joint[1]].real.data()),
          load(table[joint[2]].real.data()), load(table[joint[3]].real.data())};
}

[[gnu::always_inline]] inline void add(Four& sum, const Double4& w, const Four& q) {
  sum.x = multiply_add(spread<0>(w), q.x, sum.x);
  sum.y = multiply_add(spread<1>(w), q.y, sum.y);
  sum.z = multiply_add(spread<2>(w), q.z, sum.z);
  sum.w = multiply_add(spread<3>(w), q.w, sum.w);
}

[[gnu::always_inline]] inline Four dual_parts(const DualQuaternion* table,
                                              const std::uint16_t* joint) {
  return {load(table[joint[0]].dual.data()), load(table[joint[1]].dual.data()),
          load(table[joint[2]].dual.data()), load(table[joint[3]].dual.data())};
}

/// Weights of four quaternions with the signs that take the shorter way from the pivots.
[[gnu::always_inline]] inline Double4 signed_weights(const Double4& w, const Four& pivot,
                                                     const Four& q) {
  const Double4 dot = sums(pivot.x * q.x, pivot.y * q.y, pivot.z * q.z, pivot.w * q.w);
  return dot < 0 ? -w : w;
}

/// Blends the dual quaternions of four vertices; on return component by component.
[[gnu::always_inline]] inline void blend(const DualQuaternion* table, const Block& block,
                                         Four& real, Four& dual) {
  const Four pivot = real_parts(table, block.joints);
  real = dual = Four{all(0), all(0), all(0), all(0)};
  const Double4 first = first_weight(block);
  add(real, first, pivot);
  add(dual, first, dual_parts(table, block.joints));
  for (int s = 1; s < block.slots; ++s) {
    const Four q = real_parts(table, block.joints + 4 * s);
    const Double4 w = signed_weights(load(block.weights + 4 * (s - 1)), pivot, q);
    add(real, w, q);
    add(dual, w, dual_parts(table, block.joints + 4 * s));
  }
  transpose(real.x, real.y, real.z, real.w);
  transpose(dual.x, dual.y, dual.z, dual.w);
}

/// Posed positions of four vertices,
/// v' = v + 2 / |r|^2 ( r x (r x v + s v) + s e - u r + r x e ) with the blend's real part (r, s)
/// and dual part (e, u): Kavan et al. 2008, algorithm 1, the norm taken in once.
[[gnu::always_inline]] inline void transform(const Four& r, const Four& e, const double* rest,
                                             Double4& x, Double4& y, Double4& z) {
  const Double4 vx = load(rest), vy = load(rest + 4), vz = load(rest + 8);
  const Double4 factor = 2.0 / (r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
  // r x (r x v + s v + e) + s e - u r
  const Double4 cx = (r.y * vz - r.z * vy) + r.w * vx + e.x;
  const Double4 cy = (r.z * vx - r.x * vz) + r.w * vy + e.y;
  const Double4 cz = (r.x * vy - r.y * vx) + r.w * vz + e.z;
  x = vx + factor * ((r.y * cz - r.z * cy) + (r.w * e.x - e.w * r.x));
  y = vy + factor * ((r.z * cx - r.x * cz) + (r.w * e.y - e.w * r.y));
  z = vz + factor * ((r.x * cy - r.y * cx) + (r.w * e.z - e.w * r.z));
}

}  // namespace geoprior::skinning::lanes

#pragma GCC diagnostic pop
