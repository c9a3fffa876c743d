#include "metrics/forms/window_forms.h"

#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

/// Derivative at a row of points, whose neighbours along a line are `stride` rows apart.
Eigen::RowVector3d derivative(const Eigen::MatrixX3d& x, Eigen::Index row, Eigen::Index stride,
                              double step, DifferenceOrder order) {
  const Eigen::RowVector3d near = x.row(row + stride) - x.row(row - stride);
  if (order == DifferenceOrder::second) return near / (2 * step);
  const Eigen::RowVector3d far = x.row(row + 2 * stride) - x.row(row - 2 * stride);
  return (8 * near - far) / (12 * step);
}

double polygon_length(const Eigen::MatrixX3d& points, Eigen::Index stride) {
  double length = 0;
  const Eigen::Index n = points.rows();
  for (Eigen::Index i = 0; i < n; i += stride)
    length += (points.row((i + stride) % n) - points.row(i)).norm();
  return length;
}

}  // namespace

double FundamentalForm::norm() const { return std::sqrt(E * E + 2 * F * F + G * G); }

FundamentalForm operator-(const FundamentalForm& a, const FundamentalForm& b) {
  return {a.E - b.E, a.F - b.F, a.G - b.G};
}

std::vector<FundamentalForm> window_forms(const Eigen::MatrixX3d& points, int side, double step,
                                          DifferenceOrder order) {
  const int reach = static_cast<int>(order) / 2;
  const Eigen::Index square = static_cast<Eigen::Index>(side) * side;
  if (side <= 2 * reach) throw Error("a window has no inner point");
  if (points.rows() % square != 0)
    throw Error(std::to_string(points.rows()) + " points are no windows of " +
                std::to_string(square));
  std::vector<FundamentalForm> forms;
  for (Eigen::Index first = 0; first < points.rows(); first += square)
    for (int j = reach; j < side - reach; ++j)
      for (int i = reach; i < side - reach; ++i) {
        const Eigen::Index row = first + j * side + i;
        const Eigen::RowVector3d x = derivative(points, row, 1, step, order);
        const Eigen::RowVector3d y = derivative(points, row, side, step, order);
        forms.push_back({x.squaredNorm(), x.dot(y), y.squaredNorm()});
      }
  return forms;
}

double closed_curve_length(const Eigen::MatrixX3d& points) {
  if (points.rows() < 4 || points.rows() % 2 != 0)
    throw Error("a closed curve needs an even number of points, at least 4, not " +
                std::to_string(points.rows()));
  return (4 * polygon_length(points, 1) - polygon_length(points, 2)) / 3;
}

}  // namespace geoprior
