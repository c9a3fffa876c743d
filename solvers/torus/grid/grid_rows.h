#pragma once

#include <vector>

#include "models/torus/input.h"

namespace geoprior::torus {

/// Rows [first, end) of a periodic grid of n x n points, x, y and z apart, with `kColumnHalo`
/// columns of the other end on both sides of each. Memory is kept when it holds other rows.
class GridRows {
 public:
  static constexpr int kColumnHalo = 4;

  void hold(int n, int first, int end) {
    n_ = n;
    first_ = first;
    end_ = end;
    stride_ = n + 2 * kColumnHalo;
    const std::size_t size = 3 * static_cast<std::size_t>(end - first) * stride_;
    if (size > values_.size()) values_.resize(size);
  }
  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int end() const { return end_; }
  /// Column 0 of a coordinate of a row; columns -4 … n + 3 may be read.
  [[nodiscard]] double* row(int coordinate, int r) { return values_.data() + place(coordinate, r); }
  [[nodiscard]] const double* row(int coordinate, int r) const {
    return values_.data() + place(coordinate, r);
  }
  /// After the columns of a row are written.
  void close(int r) {
    for (int c = 0; c < 3; ++c) {
      double* x = row(c, r);
      for (int i = 1; i <= kColumnHalo; ++i) {
        x[-i] = x[n_ - i];
        x[n_ - 1 + i] = x[i - 1];
      }
    }
  }

 private:
  [[nodiscard]] std::size_t place(int coordinate, int r) const {
    return (static_cast<std::size_t>(coordinate) * (end_ - first_) + r - first_) * stride_ +
           kColumnHalo;
  }

  int n_ = 0, first_ = 0, end_ = 0, stride_ = 0;
  std::vector<double> values_;
};

/// Rows that differences reach beyond a row.
constexpr int kRowReach = 2;

/// A place where a coefficient is not positive.
struct BadNode {
  int corrugation = -1;
  int row = 0, column = 0;
  double rho = 0;
};

/// Computes all stages of the rows [begin, end): after 0, 1, … stages.size() - 1 corrugations. Each
/// has `kRowReach` rows more on both sides than the next. Row j is y = j / n; rows may lie outside
/// of 0 … n - 1.
/// @param bad  becomes the first bad node, if there is one and it names none yet
void corrugate_band(const TorusInput& input, int n, int begin, int end,
                    std::vector<GridRows>& stages, BadNode& bad);

}  // namespace geoprior::torus
