#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/parallel.h"

namespace geoprior::fluid {

/// Symmetric seven-point system on some cells of a box grid, by a compact list of its unknowns.
///
/// Unknowns count from 1 to n, x fastest; number 0 stands for "none": every vector has n + 2
/// entries whose first and last are 0, so that a missing neighbour needs no branch. Row c reads
/// diagonal x_c - sum over six neighbours of link x_neighbour, where link[a][c] couples c with its
/// upper neighbour on axis a (0: none).
struct PressureSystem {
  Eigen::Vector3i size{0, 0, 0};
  int n = 0;
  std::vector<std::int32_t> number;  ///< of every grid cell, 0: no unknown
  std::vector<std::int32_t> cell;    ///< grid cell of an unknown
  std::vector<float> diagonal;
  std::array<std::vector<float>, 3> link;
  /// Lower and upper neighbours on y and z; those on x are c - 1 and c + 1.
  std::array<std::vector<std::int32_t>, 2> lower, upper;
  std::vector<std::int32_t> by_colour;  ///< even i + j + k first, then odd
  int even = 0;                         ///< how many of them are even

  /// Sets `number`, `cell`, neighbours and colours from marks (non-zero: an unknown); makes room
  /// for the coefficients, links 0.
  void number_cells(const Eigen::Vector3i& grid, const std::vector<std::uint8_t>& marked);
  void resize_coefficients();
  /// Off-diagonal part of row c times -1.
  template <class Real>
  [[nodiscard]] Real neighbours(const Real* x, std::size_t c) const {
    const int ym = lower[0][c], yp = upper[0][c], zm = lower[1][c], zp = upper[1][c];
    return static_cast<Real>(link[0][c]) * x[c + 1] + static_cast<Real>(link[0][c - 1]) * x[c - 1] +
           static_cast<Real>(link[1][c]) * x[yp] + static_cast<Real>(link[1][ym]) * x[ym] +
           static_cast<Real>(link[2][c]) * x[zp] + static_cast<Real>(link[2][zm]) * x[zm];
  }
  /// out = A x.
  void multiply(const std::vector<double>& x, std::vector<double>& out) const;

 private:
  void find_neighbours(const std::vector<std::int32_t>& first);
  void sort_by_colour(const std::vector<std::int32_t>& first);
};

constexpr std::size_t kPressureBlock = 4096;  ///< unknowns of a parallel block

/// Combines `part(begin, end)` of blocks of fixed size in their order: the same bits for any thread
/// count.
template <class Part, class Combine>
double ordered_reduce(std::size_t n, const Part& part, const Combine& combine) {
  std::vector<double> parts((n + kPressureBlock - 1) / kPressureBlock, 0);
  parallel_blocks(n, kPressureBlock, [&](std::size_t begin, std::size_t end) {
    parts[begin / kPressureBlock] = part(begin, end);
  });
  double result = 0;
  for (const double p : parts) result = combine(result, p);
  return result;
}

double ordered_dot(const std::vector<double>& a, const std::vector<double>& b);
double largest_magnitude(const std::vector<double>& a);

}  // namespace geoprior::fluid
