#include "models/paper/cholesky/dense_front.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#if defined(__FMA__) && defined(__AVX__)
#include <immintrin.h>
#endif

#include "core/parallel.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // every function with vectors is inlined

namespace geoprior::paper {
namespace {

using Double4 [[gnu::vector_size(32)]] = double;

/// Columns that are eliminated before the rest is updated: their rows stay in the first two caches.
constexpr int kPanel = 48;
/// Multiply-adds of an update that are worth a second thread.
constexpr double kParallelWork = 1e6;

[[gnu::always_inline]] inline Double4 load(const double* p) {
  Double4 x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
[[gnu::always_inline]] inline void store(double* p, const Double4& x) {
  std::memcpy(p, &x, sizeof x);
}
/// c - a b, fused where the instruction set has it.
[[gnu::always_inline]] inline Double4 subtract_product(const Double4& c, const Double4& a,
                                                       double b) {
  const Double4 all{b, b, b, b};
#if defined(__FMA__) && defined(__AVX__)
  return _mm256_fnmadd_pd(a, all, c);
#else
  return c - a * all;
#endif
}

/// C -= A B' for `4 Lanes` rows and three columns: A (rows x depth), B (3 x depth).
template <int Lanes>
[[gnu::always_inline]] inline void subtract_tile(double* c, int c_stride, const double* a,
                                                 int a_stride, const double* b, int b_stride,
                                                 int depth) {
  Double4 sum[3][Lanes];
  for (int j = 0; j < 3; ++j) {
    for (int l = 0; l < Lanes; ++l) sum[j][l] = load(c + j * c_stride + 4 * l);
  }
  for (int k = 0; k < depth; ++k, a += a_stride, b += b_stride) {
    Double4 column[Lanes];
    for (int l = 0; l < Lanes; ++l) column[l] = load(a + 4 * l);
    for (int j = 0; j < 3; ++j) {
      for (int l = 0; l < Lanes; ++l) sum[j][l] = subtract_product(sum[j][l], column[l], b[j]);
    }
  }
  for (int j = 0; j < 3; ++j) {
    for (int l = 0; l < Lanes; ++l) store(c + j * c_stride + 4 * l, sum[j][l]);
  }
}

/// Three columns of an update, all rows from the diagonal on.
void subtract_columns(double* c, int c_stride, const double* a, int a_stride, const double* b,
                      int b_stride, int rows, int depth) {
  int i = 0;
  for (; i + 16 <= rows; i += 16) {
    subtract_tile<4>(c + i, c_stride, a + i, a_stride, b, b_stride, depth);
  }
  if (i + 8 <= rows) {
    subtract_tile<2>(c + i, c_stride, a + i, a_stride, b, b_stride, depth);
    i += 8;
  }
  for (; i < rows; i += 4) {
    subtract_tile<1>(c + i, c_stride, a + i, a_stride, b, b_stride, depth);
  }
}

/// Lower triangle of C (rows x columns from its diagonal on) -= A A' with A's rows likewise.
void update(double* c, int c_stride, const double* a, int a_stride, int rows, int columns,
            int depth) {
  if (depth == 0) return;
  const auto tile = [&](int j) {
    const double* b = a + j;
    subtract_columns(c + j + j * c_stride, c_stride, b, a_stride, b, a_stride, rows - j, depth);
  };
  if (static_cast<double>(rows) * columns * depth < kParallelWork) {
    for (int j = 0; j < columns; j += 3) tile(j);
    return;
  }
  constexpr std::size_t kBlock = 8;
  parallel_blocks(columns / 3, kBlock, [&](std::size_t begin, std::size_t end) {
    for (auto t = begin; t < end; ++t) tile(3 * static_cast<int>(t));
  });
}

/// Cholesky of a 3 x 3 diagonal block and the rows below it.
bool factorise_block(double* p, int stride, int rows) {
  double* c0 = p;
  double* c1 = p + stride;
  double* c2 = p + 2 * stride;
  if (!(c0[0] > 0)) return false;
  const double l00 = std::sqrt(c0[0]);
  const double l10 = c0[1] / l00, l20 = c0[2] / l00;
  const double d1 = c1[1] - l10 * l10;
  if (!(d1 > 0)) return false;
  const double l11 = std::sqrt(d1);
  const double l21 = (c1[2] - l20 * l10) / l11;
  const double d2 = c2[2] - l20 * l20 - l21 * l21;
  if (!(d2 > 0) || !std::isfinite(d2)) return false;
  const double l22 = std::sqrt(d2);
  const double r0 = 1 / l00, r1 = 1 / l11, r2 = 1 / l22;
  for (int i = 3; i < rows; ++i) {
    const double x0 = c0[i] * r0;
    const double x1 = (c1[i] - x0 * l10) * r1;
    c0[i] = x0;
    c1[i] = x1;
    c2[i] = (c2[i] - x0 * l20 - x1 * l21) * r2;
  }
  c0[0] = l00;
  c0[1] = l10;
  c0[2] = l20;
  c1[1] = l11;
  c1[2] = l21;
  c2[2] = l22;
  return true;
}

}  // namespace

bool factorise_front(double* panel, int stride, int height, int width) {
  for (int p = 0; p < width; p += kPanel) {
    const int end = std::min(width, p + kPanel);
    for (int j = p; j < end; j += 3) {
      double* diagonal = panel + j + j * stride;
      const double* left = panel + j + p * stride;
      subtract_columns(diagonal, stride, left, stride, left, stride, height - j, j - p);
      if (!factorise_block(diagonal, stride, height - j)) return false;
    }
    update(panel + end + end * stride, stride, panel + end + p * stride, stride, height - end,
           width - end, end - p);
  }
  return true;
}

void subtract_outer_product(double* c, int c_stride, const double* b, int b_stride, int size,
                            int depth) {
  for (int k = 0; k < depth; k += kPanel) {
    update(c, c_stride, b + k * b_stride, b_stride, size, size, std::min(kPanel, depth - k));
  }
}

void solve_front(const double* panel, int stride, int height, int width, double* x, double* y) {
  for (int j = 0; j < width; ++j) {
    const double* column = panel + j * stride;
    const double here = x[j] / column[j];
    x[j] = here;
    for (int i = j + 1; i < width; ++i) x[i] -= here * column[i];
    for (int i = width; i < height; ++i) y[i - width] -= here * column[i];
  }
}

void solve_front_transposed(const double* panel, int stride, int height, int width, double* x,
                            const double* y) {
  for (int j = width - 1; j >= 0; --j) {
    const double* column = panel + j * stride;
    // Four partial sums, so that the order is fixed and the loop is vectorised.
    Double4 sums{};
    int i = width;
    for (; i + 4 <= height; i += 4) sums += load(column + i) * load(y + i - width);
    double sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for (; i < height; ++i) sum += column[i] * y[i - width];
    for (i = j + 1; i < width; ++i) sum += column[i] * x[i];
    x[j] = (x[j] - sum) / column[j];
  }
}

}  // namespace geoprior::paper

#pragma GCC diagnostic pop
