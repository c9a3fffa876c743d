#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "baselines/fluid/liquid/grid/mac_grid.h"

namespace geoprior::fluid {

/// Where a coordinate falls between two samples of an axis: low and low + 1, weights 1 - fraction
/// and fraction. Clamped to the samples, so that beyond the last one its value goes on; a
/// coordinate that is not a number counts as 0.
struct AxisSample {
  int low = 0;
  float fraction = 0;
};

/// @param x  in sample distances, sample 0 at 0
/// @param samples  at least 2
inline AxisSample axis_sample(float x, int samples) {
  const auto last = static_cast<float>(samples - 1);
  x = x > 0 ? x : 0.0F;
  x = x < last ? x : last;
  int low = static_cast<int>(x);
  low = low < samples - 2 ? low : samples - 2;
  return {low, x - static_cast<float>(low)};
}

/// Where a point falls among the faces (n + 1 an axis) and the centres (n an axis) of the cells:
/// what all four staggered grids need of it.
struct CellSample {
  std::array<AxisSample, 3> face, centre;
  CellSample(const Eigen::Vector3f& x, const Eigen::Vector3i& cells) {
    for (int a = 0; a < 3; ++a) {
      face[a] = axis_sample(x[a], cells[a] + 1);
      centre[a] = axis_sample(x[a] - 0.5F, cells[a]);
    }
  }
  /// Where the point falls along `axis` among the samples of velocity component `component`.
  [[nodiscard]] const AxisSample& along(int axis, int component) const {
    return axis == component ? face[axis] : centre[axis];
  }
};

/// Values at the eight samples around a point, x fastest.
struct CornerValues {
  std::array<float, 8> v;
  CornerValues(const float* base, std::size_t row, std::size_t slice)
      : v{base[0],     base[1],         base[row],         base[row + 1],
          base[slice], base[slice + 1], base[slice + row], base[slice + row + 1]} {}
  [[nodiscard]] float value(float fx, float fy, float fz) const {
    const float a = v[0] + fx * (v[1] - v[0]), b = v[2] + fx * (v[3] - v[2]);
    const float c = v[4] + fx * (v[5] - v[4]), d = v[6] + fx * (v[7] - v[6]);
    const float low = a + fy * (b - a), high = c + fy * (d - c);
    return low + fz * (high - low);
  }
  /// Gradient of the interpolant, per sample distance.
  [[nodiscard]] Eigen::Vector3f gradient(float fx, float fy, float fz) const {
    const float a = v[0] + fx * (v[1] - v[0]), b = v[2] + fx * (v[3] - v[2]);
    const float c = v[4] + fx * (v[5] - v[4]), d = v[6] + fx * (v[7] - v[6]);
    const float low = a + fy * (b - a), high = c + fy * (d - c);
    const float dx_low = (1 - fy) * (v[1] - v[0]) + fy * (v[3] - v[2]);
    const float dx_high = (1 - fy) * (v[5] - v[4]) + fy * (v[7] - v[6]);
    return {dx_low + fz * (dx_high - dx_low), (1 - fz) * (b - a) + fz * (d - c), high - low};
  }
};

/// Trilinear samples of one grid of numbers; copied out of the grid for inner loops.
class GridSampler {
 public:
  explicit GridSampler(const ScalarGrid& grid)
      : data_(grid.values.data()),
        size_(grid.size),
        row_(grid.size.x()),
        slice_(row_ * static_cast<std::size_t>(grid.size.y())) {}
  [[nodiscard]] CornerValues corners(const AxisSample& x, const AxisSample& y,
                                     const AxisSample& z) const {
    const float* base = data_ + static_cast<std::size_t>(x.low) +
                        row_ * static_cast<std::size_t>(y.low) +
                        slice_ * static_cast<std::size_t>(z.low);
    return {base, row_, slice_};
  }
  /// @param x  in sample distances from sample (0, 0, 0)
  [[nodiscard]] float operator()(const Eigen::Vector3f& x) const {
    const AxisSample sx = axis_sample(x.x(), size_.x()), sy = axis_sample(x.y(), size_.y()),
                     sz = axis_sample(x.z(), size_.z());
    return corners(sx, sy, sz).value(sx.fraction, sy.fraction, sz.fraction);
  }
  /// The value at x, and in `gradient` that of the interpolant, per sample distance.
  float with_gradient(const Eigen::Vector3f& x, Eigen::Vector3f& gradient) const {
    const AxisSample sx = axis_sample(x.x(), size_.x()), sy = axis_sample(x.y(), size_.y()),
                     sz = axis_sample(x.z(), size_.z());
    const CornerValues c = corners(sx, sy, sz);
    gradient = c.gradient(sx.fraction, sy.fraction, sz.fraction);
    return c.value(sx.fraction, sy.fraction, sz.fraction);
  }

 private:
  const float* data_;
  Eigen::Vector3i size_;
  std::size_t row_, slice_;
};

/// Trilinear velocity of a staggered grid.
class FaceSampler {
 public:
  explicit FaceSampler(const MacGrid& grid)
      : cells_(grid.shape.cells),
        component_{GridSampler(grid.face[0]), GridSampler(grid.face[1]),
                   GridSampler(grid.face[2])} {}
  [[nodiscard]] CornerValues corners(const CellSample& s, int component) const {
    return component_[component].corners(s.along(0, component), s.along(1, component),
                                         s.along(2, component));
  }
  /// @param x  in cells from the grid's origin
  [[nodiscard]] Eigen::Vector3f operator()(const Eigen::Vector3f& x) const {
    const CellSample s(x, cells_);
    Eigen::Vector3f u;
    for (int a = 0; a < 3; ++a) {
      u[a] = corners(s, a).value(s.along(0, a).fraction, s.along(1, a).fraction,
                                 s.along(2, a).fraction);
    }
    return u;
  }

 private:
  Eigen::Vector3i cells_;
  std::array<GridSampler, 3> component_;
};

/// Velocity at a point (m/s), trilinear in each component; clamped to the domain.
Eigen::Vector3d velocity_at(const MacGrid& grid, const Eigen::Vector3d& x);

}  // namespace geoprior::fluid
