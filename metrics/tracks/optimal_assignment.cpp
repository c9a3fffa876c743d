#include "metrics/tracks/optimal_assignment.h"

#include <limits>

namespace geoprior {
namespace {

/// Rows <= columns; least total cost. Row by row, along a shortest augmenting path.
std::vector<int> least_cost(const Eigen::MatrixXd& cost) {
  const std::size_t rows = cost.rows();
  const std::size_t columns = cost.cols();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  // Index 0 stands for "no row" and for the column from which a path starts.
  std::vector<double> row_potential(rows + 1, 0), column_potential(columns + 1, 0);
  std::vector<std::size_t> row_of(columns + 1, 0), before(columns + 1, 0);
  for (std::size_t row = 1; row <= rows; ++row) {
    row_of[0] = row;
    std::size_t at = 0;
    std::vector<double> slack(columns + 1, kFar);
    std::vector<char> done(columns + 1, 0);
    do {
      done[at] = 1;
      double step = kFar;
      std::size_t next = 0;
      for (std::size_t c = 1; c <= columns; ++c) {
        if (done[c] != 0) continue;
        const double reduced =
            cost(row_of[at] - 1, c - 1) - row_potential[row_of[at]] - column_potential[c];
        if (reduced < slack[c]) {
          slack[c] = reduced;
          before[c] = at;
        }
        if (slack[c] < step) {
          step = slack[c];
          next = c;
        }
      }
      for (std::size_t c = 0; c <= columns; ++c) {
        if (done[c] != 0) {
          row_potential[row_of[c]] += step;
          column_potential[c] -= step;
        } else {
          slack[c] -= step;
        }
      }
      at = next;
    } while (row_of[at] != 0);
    for (; at != 0; at = before[at]) row_of[at] = row_of[before[at]];
  }
  std::vector<int> column_of(rows, -1);
  for (std::size_t c = 1; c <= columns; ++c) {
    if (row_of[c] != 0) column_of[row_of[c] - 1] = static_cast<int>(c) - 1;
  }
  return column_of;
}

}  // namespace

std::vector<int> optimal_assignment(const Eigen::MatrixXd& value) {
  if (value.rows() == 0 || value.cols() == 0) return std::vector<int>(value.rows(), -1);
  if (value.rows() <= value.cols()) return least_cost(-value);
  const std::vector<int> row_of = least_cost(-value.transpose());
  std::vector<int> column_of(value.rows(), -1);
  for (int c = 0; c < std::ssize(row_of); ++c) column_of[row_of[c]] = c;
  return column_of;
}

}  // namespace geoprior
