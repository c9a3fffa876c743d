#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "baselines/fluid/liquid/grid/mac_grid.h"

namespace geoprior::fluid {

/// Eight numbers that the processor handles at once (where it cannot, the compiler splits them).
/// Handed over by reference: by value they would make an ABI of the instruction set.
constexpr std::size_t kBatch = 8;
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));

/// Eight points, a coordinate a vector.
struct BatchPoints {
  Float8 x[3];
};

/// Eight positions from `begin` on, scaled; the last one stands in for those beyond `end`.
inline void load_batch(const std::vector<Eigen::Vector3f>& position, std::size_t begin,
                       std::size_t end, float scale, BatchPoints& out) {
  for (std::size_t l = 0; l < kBatch; ++l) {
    const Eigen::Vector3f& x = position[std::min(begin + l, end - 1)];
    for (int a = 0; a < 3; ++a) out.x[a][l] = x[a] * scale;
  }
}

/// Trilinear velocity at eight points: the same numbers as FaceSampler gives one by one, with a
/// third of the instructions.
class BatchSampler {
 public:
  explicit BatchSampler(const MacGrid& grid) {
    for (int a = 0; a < 3; ++a) {
      data_[a] = grid.face[a].values.data();
      row_[a] = grid.face[a].size.x();
      slice_[a] = row_[a] * grid.face[a].size.y();
      cells_[a] = grid.shape.cells[a];
    }
  }
  /// @param x  in cells from the grid's origin
  void sample(const BatchPoints& x, BatchPoints& u) const {
    Axis face[3], centre[3];
    for (std::size_t a = 0; a < 3; ++a) {
      locate(x.x[a], cells_[a] + 1, face[a]);
      const Float8 shifted = x.x[a] - 0.5F;
      locate(shifted, cells_[a], centre[a]);
    }
    component(0, face[0], centre[1], centre[2], u.x[0]);
    component(1, centre[0], face[1], centre[2], u.x[1]);
    component(2, centre[0], centre[1], face[2], u.x[2]);
  }

 private:
  struct Axis {
    Int8 low;
    Float8 fraction;
  };
  /// Does for eight coordinates what axis_sample (mac_grid_sampler.h) does for one.
  static void locate(const Float8& x, std::int32_t samples, Axis& out) {
    const auto last = static_cast<float>(samples - 1);
    Float8 at = x > 0.0F ? x : Float8{};
    at = at < last ? at : Float8{} + last;
    const Int8 low = __builtin_convertvector(at, Int8);
    out.low = low < samples - 2 ? low : Int8{} + (samples - 2);
    out.fraction = at - __builtin_convertvector(out.low, Float8);
  }
  static void gather(const float* base, const Int8& index, Float8& out) {
#ifdef __AVX2__
    out = Float8(_mm256_i32gather_ps(base, __m256i(index), 4));
#else
    for (std::size_t l = 0; l < kBatch; ++l) out[l] = base[index[l]];
#endif
  }
  void component(std::size_t a, const Axis& x, const Axis& y, const Axis& z, Float8& out) const {
    const std::int32_t row = row_[a], slice = slice_[a];
    const Int8 index = x.low + row * y.low + slice * z.low;
    Float8 along_x[4];
    for (int corner = 0; corner < 4; ++corner) {
      const float* base = data_[a] + (corner % 2 != 0 ? row : 0) + (corner / 2 != 0 ? slice : 0);
      Float8 low, high;
      gather(base, index, low);
      gather(base + 1, index, high);
      along_x[corner] = low + x.fraction * (high - low);
    }
    const Float8 below = along_x[0] + y.fraction * (along_x[1] - along_x[0]);
    const Float8 above = along_x[2] + y.fraction * (along_x[3] - along_x[2]);
    out = below + z.fraction * (above - below);
  }

  std::array<const float*, 3> data_{};
  std::array<std::int32_t, 3> row_{}, slice_{}, cells_{};
};

}  // namespace geoprior::fluid
