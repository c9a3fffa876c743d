#include "baselines/fluid/liquid/particles/volume_correction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr std::size_t kCellBlock = 16384;
/// With less of the kernel free than this, a cell's density says nothing.
constexpr float kSmallestRest = 0.05F;

/// Calls visit(row start, j, k) for the rows of a grid of cells, in parallel.
template <class Visit>
void for_rows(const Eigen::Vector3i& size, const Visit& visit) {
  const auto rows = static_cast<std::size_t>(size.y()) * size.z();
  parallel_blocks(rows, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const int j = static_cast<int>(r) % size.y(), k = static_cast<int>(r) / size.y();
      visit(r * size.x(), j, k);
    }
  });
}

/// The trilinear kernel's integrals over a cell and its neighbours on one axis: 1/8, 3/4, 1/8.
void filter_axis(ScalarGrid& grid, int axis) {
  const ScalarGrid from = grid;
  for_rows(grid.size, [&](std::size_t, int j, int k) {
    for (int i = 0; i < grid.size.x(); ++i) {
      Eigen::Vector3i low(i, j, k), high(i, j, k);
      low[axis] = std::max(low[axis] - 1, 0);
      high[axis] = std::min(high[axis] + 1, grid.size[axis] - 1);
      grid(i, j, k) = 0.75F * from(i, j, k) + 0.125F * from(low.x(), low.y(), low.z()) +
                      0.125F * from(high.x(), high.y(), high.z());
    }
  });
}

/// Part of a cell that is free of solids, from the distances at its corners.
float free_part(const ScalarGrid& nodes, int i, int j, int k) {
  float outside = 0, all = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const float d = nodes(i + corner % 2, j + corner / 2 % 2, k + corner / 4);
    outside += std::max(d, 0.0F);
    all += std::abs(d);
  }
  return all > 0 ? outside / all : 0.0F;
}

/// Distance over h of a density, clamped to [-1, 1].
float distance_of(float density) {
  if (density <= 0) return 1;
  if (density >= 1) return -1;
  return density <= 0.5F ? 1 - std::sqrt(2 * density) : std::sqrt(2 * (1 - density)) - 1;
}

/// Neighbours of a cell for which `inside` holds, walls included.
template <class Inside>
int count_sides(const Eigen::Vector3i& size, const Eigen::Vector3i& at, const Inside& inside) {
  int count = 0;
  for (int a = 0; a < 3; ++a) {
    for (const int step : {-1, 1}) {
      Eigen::Vector3i n = at;
      n[a] += step;
      if (n[a] < 0 || n[a] >= size[a] || inside(n)) ++count;
    }
  }
  return count;
}

void close_holes(ScalarGrid& distance, float h) {
  const ScalarGrid before = distance;
  for_rows(distance.size, [&](std::size_t row, int j, int k) {
    for (int i = 0; i < distance.size.x(); ++i) {
      const std::size_t at = row + i;
      if (before.values[at] < 0 || before.values[at] >= h) continue;
      const int sides = count_sides(distance.size, {i, j, k}, [&](const Eigen::Vector3i& n) {
        return before(n.x(), n.y(), n.z()) < 0;
      });
      if (sides >= 5) distance.values[at] = -0.5F * h;
    }
  });
}

/// The smallest of three on one axis, in place: after three passes 1 where a cell and all 26
/// around it are liquid.
void shrink_axis(std::vector<char>& inside, const Eigen::Vector3i& size, int axis) {
  const std::vector<char> from = inside;
  const std::size_t stride = axis == 0 ? 1
                                       : static_cast<std::size_t>(size.x()) *
                                             (axis == 1 ? 1 : static_cast<std::size_t>(size.y()));
  for_rows(size, [&](std::size_t row, int j, int k) {
    for (int i = 0; i < size.x(); ++i) {
      const int at = axis == 0 ? i : axis == 1 ? j : k;
      const std::size_t c = row + i;
      char all = from[c];
      if (at > 0) all = static_cast<char>(all & from[c - stride]);
      if (at + 1 < size[axis]) all = static_cast<char>(all & from[c + stride]);
      inside[c] = all;
    }
  });
}

}  // namespace

ScalarGrid rest_density(const SolidFractions& solids, const GridShape& shape) {
  ScalarGrid rest(shape.cells, 1.0F);
  for_rows(shape.cells, [&](std::size_t row, int j, int k) {
    for (int i = 0; i < shape.cells.x(); ++i) {
      rest.values[row + i] = free_part(solids.distance, i, j, k);
    }
  });
  for (int axis = 0; axis < 3; ++axis) filter_axis(rest, axis);
  return rest;
}

void liquid_distance(const ScalarGrid& density, const ScalarGrid* rest, const GridShape& shape,
                     ScalarGrid& distance) {
  const auto h = static_cast<float>(shape.cell);
  distance.size = shape.cells;
  distance.values.resize(density.values.size());
  parallel_blocks(density.values.size(), kCellBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const float full = rest != nullptr ? rest->values[c] : 1.0F;
      distance.values[c] = full < kSmallestRest ? h : h * distance_of(density.values[c] / full);
    }
  });
  close_holes(distance, h);
}

void density_target(const ScalarGrid& density, const ScalarGrid* rest, const ScalarGrid& distance,
                    double strength, double bound, ScalarGrid& target) {
  target.size = distance.size;
  target.values.resize(distance.values.size());
  std::vector<char> inside(distance.values.size());
  parallel_blocks(inside.size(), kCellBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) inside[c] = distance.values[c] < 0 ? 1 : 0;
  });
  for (int axis = 0; axis < 3; ++axis) shrink_axis(inside, distance.size, axis);
  const auto factor = static_cast<float>(strength), most = static_cast<float>(bound);
  parallel_blocks(inside.size(), kCellBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const float full = rest != nullptr ? rest->values[c] : 1.0F;
      const float ratio = full < kSmallestRest ? 1.0F : density.values[c] / full;
      const float excess = inside[c] != 0 ? ratio - 1 : std::max(ratio - 1, 0.0F);
      target.values[c] = distance.values[c] < 0 ? std::clamp(factor * excess, -most, most) : 0.0F;
    }
  });
}

double liquid_volume(const ScalarGrid& distance, const GridShape& shape) {
  double sum = 0;
  for (const float d : distance.values) {
    sum += std::clamp(0.5 - static_cast<double>(d) / shape.cell, 0.0, 1.0);
  }
  return sum * std::pow(shape.cell, 3);
}

}  // namespace geoprior::fluid
