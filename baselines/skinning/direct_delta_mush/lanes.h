#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "baselines/skinning/linear_blend/lanes.h"
#include "baselines/skinning/shared/rotation_lanes.h"

// Direct delta mush of four vertices at a time: what direct_delta_mush() writes out for one.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function here is inlined: no ABI is crossed

namespace geoprior::skinning::lanes {

/// Adds row r of [R M p] Omega for all three r; `w` are the rows of Omega.
///
/// (M p)_r = sum_c R_rc p_c + t_r, so that row r is sum_c R_rc (w_c + p_c w_3) + t_r w_3.
[[gnu::always_inline]] inline void add_moved(const MatrixRows& M, const std::array<Double4, 3>& p,
                                             const std::array<Double4, 4>& w, BlendedRows& sum) {
  const Double4 x = multiply_add(p[0], w[3], w[0]);
  const Double4 y = multiply_add(p[1], w[3], w[1]);
  const Double4 z = multiply_add(p[2], w[3], w[2]);
  const auto add_row = [&](const double* m, Double4& row) {
    row = multiply_add(all(m[0]), x, row);
    row = multiply_add(all(m[1]), y, row);
    row = multiply_add(all(m[2]), z, row);
    row = multiply_add(all(m[3]), w[3], row);
  };
  add_row(M.row.data(), sum.row0);
  add_row(M.row.data() + 4, sum.row1);
  add_row(M.row.data() + 8, sum.row2);
}

/// [S q] of one vertex by rows. `matrices` are of 16 floats each, the strongest joint's first: it
/// is added last, with the last row that the others leave of (0, 0, 0, 1).
template <class Matrix>
[[gnu::always_inline]] inline BlendedRows moved_patch(const MatrixRows* table,
                                                      const std::uint16_t* joints,
                                                      std::span<const Matrix> matrices,
                                                      const std::array<Double4, 3>& p) {
  BlendedRows sum{all(0), all(0), all(0)};
  Double4 left{0, 0, 0, 1};
  for (std::size_t e = 1; e < matrices.size(); ++e) {
    const float* w = matrices[e].row.data();
    const Double4 last = load(w + 12);
    left -= last;
    add_moved(table[joints[e]], p, {load(w), load(w + 4), load(w + 8), last}, sum);
  }
  const float* w = matrices[0].row.data();
  add_moved(table[joints[0]], p, {load(w), load(w + 4), load(w + 8), left}, sum);
  return sum;
}

/// Posed positions of four vertices from their patches: q + R d, R the rotation nearest to S.
[[gnu::always_inline]] inline void place(std::array<BlendedRows, 4>& patch, const double* detail,
                                         Double4& x, Double4& y, Double4& z) {
  const auto by_element = [&patch](Double4 BlendedRows::*row) {
    transpose(patch[0].*row, patch[1].*row, patch[2].*row, patch[3].*row);
  };
  by_element(&BlendedRows::row0);
  by_element(&BlendedRows::row1);
  by_element(&BlendedRows::row2);
  Matrices S;
  for (int c = 0; c < 3; ++c) {
    const BlendedRows& column = patch[c];
    S.m[0][c] = column.row0;
    S.m[1][c] = column.row1;
    S.m[2][c] = column.row2;
  }
  const Matrices R = nearest_rotations(S);
  const Double4 dx = load(detail), dy = load(detail + 4), dz = load(detail + 8);
  const auto turned = [&](int r) { return R.m[r][0] * dx + R.m[r][1] * dy + R.m[r][2] * dz; };
  x = patch[3].row0 + turned(0);
  y = patch[3].row1 + turned(1);
  z = patch[3].row2 + turned(2);
}

}  // namespace geoprior::skinning::lanes

#pragma GCC diagnostic pop
