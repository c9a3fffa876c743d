#pragma once

#include <Eigen/Core>

namespace geoprior::paper {

/// Dense columns of a front: column-major, the first of `stride` doubles a column. Rows are padded:
/// the kernels may read and write up to `kFrontPadding` rows past the last.
constexpr int kFrontPadding = 3;

/// Smallest stride for so many rows.
constexpr int front_stride(int rows) { return (rows + kFrontPadding + 3) / 4 * 4; }

/// Cholesky factorisation of the first `width` columns of a symmetric matrix with `height` rows,
/// lower triangle, in place: L11 L11' = A11, L21 = A21 L11^-T. `width` is a multiple of 3.
/// @return  false when a pivot is not positive (or not a number)
bool factorise_front(double* panel, int stride, int height, int width);

/// C -= B B', lower triangle: C with `size` rows and columns, B with `size` rows and `depth`
/// columns. The result does not depend on the number of threads. `size` is a multiple of 3.
void subtract_outer_product(double* c, int c_stride, const double* b, int b_stride, int size,
                            int depth);

/// x := L11^-1 x (the first `width` of `height`), y -= L21 x.
void solve_front(const double* panel, int stride, int height, int width, double* x, double* y);

/// x := L11^-T (x - L21' y).
void solve_front_transposed(const double* panel, int stride, int height, int width, double* x,
                            const double* y);

}  // namespace geoprior::paper
