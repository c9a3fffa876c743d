#include "baselines/fluid/liquid/particles/particles.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kRowBlock = 32;
constexpr std::size_t kGatherBlock = 8192;

/// Cell of a coordinate in cells; clamped, not a number counts as 0.
std::uint32_t cell_of(float x, int cells) {
  const auto last = static_cast<float>(cells - 1);
  x = x > 0 ? x : 0.0F;
  return static_cast<std::uint32_t>(x < last ? x : last);
}

template <class T>
void gather_array(const std::vector<std::uint32_t>& order, std::vector<T>& from,
                  std::vector<T>& to) {
  to.resize(from.size());
  parallel_blocks(order.size(), kGatherBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) to[k] = from[order[k]];
  });
  from.swap(to);
}

}  // namespace

void CellSorter::count_rows(const GridShape& shape, const LiquidParticles& particles) {
  const std::size_t n = particles.size();
  const std::uint32_t nx = shape.cells.x();
  const std::uint32_t ny = shape.cells.y();
  const std::size_t rows = static_cast<std::size_t>(ny) * shape.cells.z();
  // At most 32 blocks: their counters, one a row, must not outgrow the cache.
  block_ = std::max<std::size_t>(16384, (n + 31) / 32);
  const std::size_t blocks = (n + block_ - 1) / block_;
  cell_.resize(n);
  count_.assign(blocks * rows, 0);
  const auto per_metre = static_cast<float>(1 / shape.cell);
  parallel_blocks(n, block_, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* count = count_.data() + (begin / block_) * rows;
    for (std::size_t p = begin; p < end; ++p) {
      const Eigen::Vector3f& x = particles.position[p];
      const std::uint32_t row = cell_of(x.y() * per_metre, shape.cells.y()) +
                                ny * cell_of(x.z() * per_metre, shape.cells.z());
      cell_[p] = cell_of(x.x() * per_metre, shape.cells.x()) + nx * row;
      ++count[row];
    }
  });
}

/// Turns counts into the places where each block puts its particles of a row.
void CellSorter::spread_rows(std::size_t rows) {
  const std::size_t n = cell_.size();
  const std::size_t blocks = (n + block_ - 1) / block_;
  row_begin_.resize(rows + 1);
  std::uint32_t next = 0;
  for (std::size_t r = 0; r < rows; ++r) {
    row_begin_[r] = next;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::uint32_t count = count_[b * rows + r];
      count_[b * rows + r] = next;
      next += count;
    }
  }
  row_begin_[rows] = next;
}

void CellSorter::sort_rows(const GridShape& shape, LiquidParticles& particles) {
  const std::size_t nx = shape.cells.x();
  const std::size_t rows = shape.cell_count() / nx;
  const std::size_t n = cell_.size();
  by_row_.resize(n);
  order_.resize(n);
  particles.cell_begin.resize(shape.cell_count() + 1);
  parallel_blocks(n, block_, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* next = count_.data() + (begin / block_) * rows;
    for (std::size_t p = begin; p < end; ++p) {
      by_row_[next[cell_[p] / nx]++] = static_cast<std::uint32_t>(p);
    }
  });
  parallel_blocks(rows, kRowBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> next(nx + 1);
    for (std::size_t r = begin; r < end; ++r) {
      std::fill(next.begin(), next.end(), 0U);
      for (std::uint32_t k = row_begin_[r]; k < row_begin_[r + 1]; ++k) {
        ++next[cell_[by_row_[k]] - r * nx + 1];
      }
      next[0] = row_begin_[r];
      for (std::size_t i = 0; i < nx; ++i) {
        next[i + 1] += next[i];
        particles.cell_begin[r * nx + i] = next[i];
      }
      for (std::uint32_t k = row_begin_[r]; k < row_begin_[r + 1]; ++k) {
        order_[next[cell_[by_row_[k]] - r * nx]++] = by_row_[k];
      }
    }
  });
  particles.cell_begin.back() = static_cast<std::uint32_t>(n);
}

void CellSorter::gather(LiquidParticles& particles) {
  gather_array(order_, particles.position, sorted_.position);
  gather_array(order_, particles.velocity, sorted_.velocity);
  if (!particles.affine.empty()) gather_array(order_, particles.affine, sorted_.affine);
}

void CellSorter::sort(const GridShape& shape, LiquidParticles& particles) {
  const std::size_t rows = shape.cell_count() / static_cast<std::size_t>(shape.cells.x());
  count_rows(shape, particles);
  spread_rows(rows);
  sort_rows(shape, particles);
  gather(particles);
}

void sort_by_cell(const GridShape& shape, LiquidParticles& particles) {
  CellSorter().sort(shape, particles);
}

void remove_particles(const std::vector<std::uint8_t>& removed, LiquidParticles& particles) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < removed.size(); ++p) {
    if (removed[p] != 0) continue;
    particles.position[kept] = particles.position[p];
    particles.velocity[kept] = particles.velocity[p];
    if (!particles.affine.empty()) particles.affine[kept] = particles.affine[p];
    ++kept;
  }
  particles.position.resize(kept);
  particles.velocity.resize(kept);
  if (!particles.affine.empty()) particles.affine.resize(kept);
}

}  // namespace geoprior::fluid
