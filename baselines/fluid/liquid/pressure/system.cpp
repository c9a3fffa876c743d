#include "baselines/fluid/liquid/pressure/system.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

/// Unknowns of every layer z = k, then their first numbers.
std::vector<std::int32_t> first_numbers(std::size_t layer, std::size_t layers,
                                        const std::vector<std::uint8_t>& marked) {
  std::vector<std::int32_t> first(layers + 1, 0);
  parallel_blocks(layers, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::int32_t count = 0;
      for (std::size_t i = k * layer; i < (k + 1) * layer; ++i) count += marked[i] != 0;
      first[k + 1] = count;
    }
  });
  first[0] = 1;
  for (std::size_t k = 0; k < layers; ++k) first[k + 1] += first[k];
  return first;
}

}  // namespace

void PressureSystem::resize_coefficients() {
  const auto entries = static_cast<std::size_t>(n) + 2;
  diagonal.assign(entries, 0);
  for (auto& values : link) values.assign(entries, 0);
}

void PressureSystem::number_cells(const Eigen::Vector3i& grid,
                                  const std::vector<std::uint8_t>& marked) {
  size = grid;
  const std::size_t layer = static_cast<std::size_t>(size.x()) * size.y(),
                    layers = static_cast<std::size_t>(size.z());
  const std::vector<std::int32_t> first = first_numbers(layer, layers, marked);
  n = first.back() - 1;
  number.resize(layer * layers);
  cell.assign(n + 2, 0);
  parallel_blocks(layers, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::int32_t next = first[k];
      for (std::size_t i = k * layer; i < (k + 1) * layer; ++i) {
        if (marked[i]) cell[next] = static_cast<std::int32_t>(i);
        number[i] = marked[i] ? next++ : 0;
      }
    }
  });
  find_neighbours(first);
  sort_by_colour(first);
}

/// @param first  number of the first unknown of every layer z = k, and n + 1
void PressureSystem::find_neighbours(const std::vector<std::int32_t>& first) {
  const auto nx = static_cast<std::size_t>(size.x()), ny = static_cast<std::size_t>(size.y()),
             nz = static_cast<std::size_t>(size.z()), layer = nx * ny;
  for (auto* table : {&lower, &upper})
    for (auto& values : *table) values.assign(cell.size(), 0);
  parallel_blocks(nz, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t c = first[k]; c < static_cast<std::size_t>(first[k + 1]); ++c) {
        const auto at = static_cast<std::size_t>(cell[c]), j = at / nx - k * ny;
        lower[0][c] = j > 0 ? number[at - nx] : 0;
        upper[0][c] = j + 1 < ny ? number[at + nx] : 0;
        lower[1][c] = k > 0 ? number[at - layer] : 0;
        upper[1][c] = k + 1 < nz ? number[at + layer] : 0;
      }
  });
}

void PressureSystem::sort_by_colour(const std::vector<std::int32_t>& first) {
  const std::size_t nx = size.x(), ny = size.y(), nz = size.z();
  const auto is_odd = [&](std::int32_t c, std::size_t k) {
    const auto at = static_cast<std::size_t>(cell[c]), row = at / nx;
    return (((at - row * nx) + (row - k * ny) + k) & 1) != 0;
  };
  std::vector<std::int32_t> evens(nz + 1, 0);
  parallel_blocks(nz, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      for (std::int32_t c = first[k]; c < first[k + 1]; ++c) evens[k + 1] += !is_odd(c, k);
  });
  for (std::size_t k = 0; k < nz; ++k) evens[k + 1] += evens[k];
  even = evens[nz];
  by_colour.resize(n);
  parallel_blocks(nz, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::size_t next_even = evens[k];
      std::size_t next_odd = even + first[k] - 1 - evens[k];
      for (std::int32_t c = first[k]; c < first[k + 1]; ++c)
        by_colour[is_odd(c, k) ? next_odd++ : next_even++] = c;
    }
  });
}

void PressureSystem::multiply(const std::vector<double>& x, std::vector<double>& out) const {
  parallel_blocks(n, kPressureBlock, [&](std::size_t begin, std::size_t end) {
    const double* values = x.data();
    for (std::size_t c = begin + 1; c <= end; ++c)
      out[c] = static_cast<double>(diagonal[c]) * values[c] - neighbours(values, c);
  });
}

double ordered_dot(const std::vector<double>& a, const std::vector<double>& b) {
  return ordered_reduce(
      a.size(),
      [&](std::size_t begin, std::size_t end) {
        double sum[4] = {0, 0, 0, 0};
        std::size_t i = begin;
        for (; i + 4 <= end; i += 4)
          for (std::size_t l = 0; l < 4; ++l) sum[l] += a[i + l] * b[i + l];
        for (; i < end; ++i) sum[0] += a[i] * b[i];
        return (sum[0] + sum[1]) + (sum[2] + sum[3]);
      },
      [](double x, double y) { return x + y; });
}

double largest_magnitude(const std::vector<double>& a) {
  return ordered_reduce(
      a.size(),
      [&](std::size_t begin, std::size_t end) {
        double largest = 0;
        for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, std::abs(a[i]));
        return largest;
      },
      [](double x, double y) { return std::max(x, y); });
}

}  // namespace geoprior::fluid
