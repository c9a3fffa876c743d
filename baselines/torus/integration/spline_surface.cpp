#include "baselines/torus/integration/spline_surface.h"

#include <cmath>

#include "core/parallel.h"

namespace geoprior::torus {
namespace {

/// B-spline coefficients of n values with a period, in place, `stride` apart: (c_{i-1} + 4 c_i +
/// c_{i+1}) / 6 = f_i, by a filter forth and one back with the pole sqrt 3 - 2 (Unser 1999).
void filter(Eigen::Vector4d* f, int n, Eigen::Index stride) {
  const double pole = std::sqrt(3.) - 2;
  const double closing = 1 / (1 - std::pow(pole, n));
  const auto at = [&](int i) -> Eigen::Vector4d& { return f[i * stride]; };
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int i = 1; i < n; ++i) sum = pole * sum + at(i);  // of all before the first, round and round
  at(0) = (at(0) + pole * sum) * closing;
  for (int i = 1; i < n; ++i) at(i) += pole * at(i - 1);
  sum.setZero();
  for (int i = n - 2; i >= 0; --i) sum = pole * sum + at(i);
  at(n - 1) = (at(n - 1) + pole * sum) * closing;
  for (int i = n - 2; i >= 0; --i) at(i) += pole * at(i + 1);
  for (int i = 0; i < n; ++i) at(i) *= -6 * pole;
}

/// The four cubic B-splines that reach a point, and their derivatives in units of the grid.
struct Weights {
  std::array<double, 4> value, slope;
};

Weights weights(double u) {
  const double v = 1 - u;
  return {{v * v * v / 6, (4 - 6 * u * u + 3 * u * u * u) / 6, (4 - 6 * v * v + 3 * v * v * v) / 6,
           u * u * u / 6},
          {-v * v / 2, -2 * u + 1.5 * u * u, 2 * v - 1.5 * v * v, u * u / 2}};
}

int wrapped(int i, int n) {
  const int rest = i % n;
  return rest < 0 ? rest + n : rest;
}

}  // namespace

SplineSurface::SplineSurface(const GridSurface& surface)
    : n_(surface.n), coefficients_(static_cast<std::size_t>(surface.n) * surface.n) {
  constexpr std::size_t kBlock = 16;
  parallel_blocks(n_, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      Eigen::Vector4d* row = coefficients_.data() + j * n_;
      for (int i = 0; i < n_; ++i)
        row[i] << surface.x[0](i, j), surface.x[1](i, j), surface.x[2](i, j), 0;
      filter(row, n_, 1);
    }
  });
  parallel_blocks(n_, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) filter(coefficients_.data() + i, n_, n_);
  });
}

SplineSurface::Point SplineSurface::at(const Eigen::Vector2d& parameter) const {
  const Eigen::Vector2d place = n_ * parameter;
  const double i = std::floor(place.x()), j = std::floor(place.y());
  const Weights across = weights(place.x() - i), up = weights(place.y() - j);
  std::array<int, 4> column{};
  for (int k = 0; k < 4; ++k) column[k] = wrapped(static_cast<int>(i) + k - 1, n_);
  Eigen::Vector4d value = Eigen::Vector4d::Zero(), x = value, y = value;
  for (int l = 0; l < 4; ++l) {
    const Eigen::Vector4d* row =
        coefficients_.data() +
        static_cast<std::size_t>(wrapped(static_cast<int>(j) + l - 1, n_)) * n_;
    Eigen::Vector4d here = Eigen::Vector4d::Zero(), slope = here;
    for (int k = 0; k < 4; ++k) {
      here += across.value[k] * row[column[k]];
      slope += across.slope[k] * row[column[k]];
    }
    value += up.value[l] * here;
    x += up.value[l] * slope;
    y += up.slope[l] * here;
  }
  return {value.head<3>(), n_ * x.head<3>(), n_ * y.head<3>()};
}

}  // namespace geoprior::torus
