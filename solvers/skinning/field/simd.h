#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace geoprior::skinning {

/// Four floats in one register (x, y, z and one more): the unit in which the per-frame passes work.
/// A vector extension of GCC and Clang, so the same source serves every instruction set.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 splat(float x) { return Float4{x, x, x, x}; }

inline Float4 to_float4(const Eigen::Vector3d& v) {
  return Float4{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
                0.0F};
}

/// Sum of products of the first three components.
inline float dot3(Float4 a, Float4 b) {
  const Float4 product = a * b;
  return product[0] + product[1] + product[2];
}

/// Length of the first three components.
inline float length3(Float4 a) { return std::sqrt(dot3(a, a)); }

/// Cross product of the first three components; the fourth is zero.
inline Float4 cross3(Float4 a, Float4 b) {
  return Float4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
                0.0F};
}

/// v turned by the unit quaternion q (x, y, z, w).
inline Float4 turned(Float4 q, Float4 v) {
  const Float4 t = splat(2) * cross3(q, v);
  return v + splat(q[3]) * t + cross3(q, t);
}

/// 0 up to `low`, 1 from `high` on, smooth between.
inline float smooth_ramp(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// Box around points.
struct Float4Bounds {
  Float4 low = splat(std::numeric_limits<float>::max());
  Float4 high = splat(std::numeric_limits<float>::lowest());
  void include(Float4 p) {
    low = p < low ? p : low;
    high = p > high ? p : high;
  }
};

/// First three components; the fourth set to zero.
inline Float4 xyz(Float4 a) { return Float4{a[0], a[1], a[2], 0.0F}; }

}  // namespace geoprior::skinning
