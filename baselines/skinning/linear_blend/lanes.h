#pragma once

#include <array>
#include <cstdint>

#include "baselines/skinning/shared/lanes.h"

// Linear blending of four vertices at a time: the sum that linear_blend() writes out for one.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function here is inlined: no ABI is crossed

namespace geoprior::skinning::lanes {

/// Upper three rows of a transform, padded to two cache lines: a joint's index becomes its address
/// by one shift.
struct alignas(128) MatrixRows {
  std::array<double, 12> row;
};

struct BlendedRows {
  Double4 row0, row1, row2;
};

template <int lane, class Joint>
[[gnu::always_inline]] inline void add(const Joint* table, std::uint16_t joint,
                                       const Double4& weights, BlendedRows& sum) {
  const double* row = table[joint].row.data();
  const Double4 w = spread<lane>(weights);
  sum.row0 = multiply_add(w, load(row), sum.row0);
  sum.row1 = multiply_add(w, load(row + 4), sum.row1);
  sum.row2 = multiply_add(w, load(row + 8), sum.row2);
}

/// Rows of the blended matrix of one vertex. `Slots` > 0 is the number of influences known when
/// compiling; 0 asks the block. A `Joint` has `row`, as MatrixRows. The strongest influence comes
/// last: its weight is known last.
template <int Slots, int lane, class Joint>
[[gnu::always_inline]] inline BlendedRows blend_rows(const Joint* table, const Block& block,
                                                     const Double4& first_weight) {
  BlendedRows sum{all(0), all(0), all(0)};
  const int slots = Slots > 0 ? Slots : block.slots;
#pragma GCC unroll 4
  for (int s = 1; s < slots; ++s) {
    add<lane>(table, block.joints[4 * s + lane], load(block.weights + 4 * (s - 1)), sum);
  }
  add<lane>(table, block.joints[lane], first_weight, sum);
  return sum;
}

/// One row of four blended matrices, applied to the four rest positions.
[[gnu::always_inline]] inline Double4 apply(Double4 a, Double4 b, Double4 c, Double4 d,
                                            const Double4& x, const Double4& y, const Double4& z) {
  transpose(a, b, c, d);
  return multiply_add(a, x, multiply_add(b, y, multiply_add(c, z, d)));
}

template <int Slots, class Joint>
[[gnu::always_inline]] inline void blend_slots(const Joint* table, const Block& block, Double4& x,
                                               Double4& y, Double4& z) {
  const Double4 w = first_weight(block);
  const BlendedRows a = blend_rows<Slots, 0>(table, block, w),
                    b = blend_rows<Slots, 1>(table, block, w),
                    c = blend_rows<Slots, 2>(table, block, w),
                    d = blend_rows<Slots, 3>(table, block, w);
  const Double4 rest_x = load(block.rest), rest_y = load(block.rest + 4),
                rest_z = load(block.rest + 8);
  x = apply(a.row0, b.row0, c.row0, d.row0, rest_x, rest_y, rest_z);
  y = apply(a.row1, b.row1, c.row1, d.row1, rest_x, rest_y, rest_z);
  z = apply(a.row2, b.row2, c.row2, d.row2, rest_x, rest_y, rest_z);
}

/// The rest positions of a block, moved by their blended matrices.
template <class Joint>
[[gnu::always_inline]] inline void blend_block(const Joint* table, const Block& block, Double4& x,
                                               Double4& y, Double4& z) {
  switch (block.slots) {
    case 1:
      return blend_slots<1>(table, block, x, y, z);
    case 2:
      return blend_slots<2>(table, block, x, y, z);
    case 3:
      return blend_slots<3>(table, block, x, y, z);
    case 4:
      return blend_slots<4>(table, block, x, y, z);
    default:
      return blend_slots<0>(table, block, x, y, z);
  }
}

}  // namespace geoprior::skinning::lanes

#pragma GCC diagnostic pop
