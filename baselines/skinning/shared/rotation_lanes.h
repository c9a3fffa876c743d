#pragma once

#include <algorithm>
#include <cmath>

#include "baselines/skinning/shared/lanes.h"

// Nearest rotations of four matrices at a time.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function here is inlined: no ABI is crossed

namespace geoprior::skinning::lanes {

/// Four 3 x 3 matrices, element by element: m[row][column].
struct Matrices {
  Double4 m[3][3];
};

[[gnu::always_inline]] inline Double4 square_root(const Double4& x) {
#if defined(__AVX__)
  return _mm256_sqrt_pd(x);
#else
  return Double4{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}

[[gnu::always_inline]] inline Double4 larger(const Double4& a, const Double4& b) {
  return a > b ? a : b;
}

[[gnu::always_inline]] inline double largest_of(const Double4& x) {
  return std::max(std::max(x[0], x[1]), std::max(x[2], x[3]));
}

/// Sum of the squares of the elements.
[[gnu::always_inline]] inline Double4 squared_norm(const Matrices& a) {
  Double4 sum = all(0);
  for (const auto& row : a.m) {
    for (const Double4& x : row) sum = multiply_add(x, x, sum);
  }
  return sum;
}

/// Matrices of signed minors: cofactors(A) = det(A) A^-T.
[[gnu::always_inline]] inline Matrices cofactors(const Matrices& a) {
  Matrices c;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c.m[i][j] = a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1];
    }
  }
  return c;
}

/// Sum of the singular values of matrices of norm 1, the smallest with the sign of the determinant:
/// the largest root of
///
///   (x^2 - 1)^2 = 4 K + 8 D x,     K = |cofactors|^2, D = determinant.
///
/// Newton's iteration from above, where the quartic is convex and increasing, so that it falls
/// monotonically: it starts at the root itself where D = 0, as it nearly is for a patch of skin,
/// which is almost flat.
[[gnu::always_inline]] inline Double4 sum_of_singular_values(const Double4& K, const Double4& D) {
  constexpr int kMostSteps = 60;  // a double root converges by halves
  constexpr double kSqrt3 = 1.7320508075688772;
  const Double4 upward = larger(D, all(0)) * (2 * kSqrt3);
  Double4 x = square_root(1.0 + 2.0 * square_root(K + upward));
  for (int step = 0; step < kMostSteps; ++step) {
    const Double4 u = x * x - 1.0;
    const Double4 value = u * u - 4.0 * K - 8.0 * D * x;
    const Double4 slope = 4.0 * u * x - 8.0 * D;
    x -= larger(value, all(0)) / larger(slope, all(1e-12));
    if (largest_of(value) < 1e-14) break;  // what was left of it is removed by this step
  }
  return x;
}

/// Rotations R that maximise tr(R^T A): the orthogonal factors of the polar decompositions, with
/// the direction of the smallest singular value turned round where the determinant is negative.
///
/// With s the signed sum of the singular values and A scaled to norm 1 (Markley 1993, "FOAM"):
///
///   R = ((k + 1) A + s cofactors(A) - A A^T A) / (k s - det A),   k = (s^2 - 1) / 2
///
/// No eigenvectors, no cases. The result loses as many digits as the denominator, which is the
/// product of the pairwise sums of singular values, is smaller than 1: A must not be close to rank
/// one, or to a reflection of equal smaller values.
[[gnu::always_inline]] inline Matrices nearest_rotations(const Matrices& matrices) {
  const Double4 scale = 1.0 / square_root(larger(squared_norm(matrices), all(1e-300)));
  Matrices a;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) a.m[i][j] = scale * matrices.m[i][j];
  }
  const Matrices c = cofactors(a);
  const Double4 D = a.m[0][0] * c.m[0][0] + a.m[0][1] * c.m[0][1] + a.m[0][2] * c.m[0][2];
  const Double4 s = sum_of_singular_values(squared_norm(c), D);
  const Double4 k = 0.5 * (s * s - 1.0);
  const Double4 inverse = 1.0 / larger(k * s - D, all(1e-300));
  Matrices R;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    // Row i of (k + 1) I - A A^T.
    Double4 left[3];
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      const Double4 product = a.m[i][0] * a.m[j][0] + a.m[i][1] * a.m[j][1] + a.m[i][2] * a.m[j][2];
      left[j] = i == j ? k + 1.0 - product : -product;
    }
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      R.m[i][j] = inverse *
                  (left[0] * a.m[0][j] + left[1] * a.m[1][j] + left[2] * a.m[2][j] + s * c.m[i][j]);
    }
  }
  return R;
}

}  // namespace geoprior::skinning::lanes

#pragma GCC diagnostic pop
