#include "metrics/arrangement/point_grid.h"

#include <cmath>
#include <utility>

namespace geoprior {
namespace {

/// Side of the cells in which a box of these sides holds `count` points, two each. Sides that are
/// shorter than a cell do not count: the points lie in a plane, or on a line.
double cell_side(Eigen::Vector3d sides, double count) {
  std::sort(sides.data(), sides.data() + 3);
  const double cells = std::max(1.0, count / 2);
  for (int k = 0; k < 3; ++k) {
    const double side = std::pow(sides.tail(3 - k).prod() / cells, 1.0 / (3 - k));
    if (side > 0 && side <= sides[k]) return side;
  }
  return sides[2] > 0 ? sides[2] : 1;
}

}  // namespace

PointGrid::PointGrid(std::vector<Eigen::Vector3d> points) : points_(std::move(points)) {
  if (points_.empty()) return;
  low_ = high_ = points_.front();
  for (const Eigen::Vector3d& x : points_) {
    low_ = low_.cwiseMin(x);
    high_ = high_.cwiseMax(x);
  }
  cell_ = cell_side(high_ - low_, static_cast<double>(points_.size()));
  for (int k = 0; k < 3; ++k)
    cells_[k] = 1 + static_cast<int>(std::floor((high_[k] - low_[k]) / cell_));
  const auto number = [&](const Eigen::Vector3d& x) {
    const std::array<int, 3> c = cell_of(x);
    return (c[2] * cells_[1] + c[1]) * cells_[0] + c[0];
  };
  begin_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
  for (const Eigen::Vector3d& x : points_) ++begin_[number(x) + 1];
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  entry_.resize(points_.size());
  for (int i = 0; i < size(); ++i) entry_[next[number(points_[i])]++] = i;
}

PointGrid::Nearest PointGrid::nearest(const Eigen::Vector3d& x, int except) const {
  Nearest out;
  if (size() == 0 || (size() == 1 && except == 0)) return out;
  // Any point is within the distance of the farthest corner of the box.
  const Eigen::Vector3d farthest = (x - low_).cwiseAbs().cwiseMax((x - high_).cwiseAbs());
  const double outside = (x - x.cwiseMax(low_).cwiseMin(high_)).norm();
  for (double radius = outside + cell_;; radius *= 2) {
    visit(x, radius, [&](int i, double distance) {
      if (i == except || distance > out.distance) return;
      if (distance < out.distance || i < out.point) out = {i, distance};
    });
    if (out.point >= 0 || radius > farthest.norm()) return out;
  }
}

}  // namespace geoprior
