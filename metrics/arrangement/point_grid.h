#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace geoprior {

/// Points in space, found again by the cells of a uniform grid: about two points a cell where they
/// fill their box, or the plane or line that it is, evenly.
///
/// Queries may be asked from several threads at once. Their order depends on the points alone.
class PointGrid {
 public:
  /// @param points  finite (m)
  explicit PointGrid(std::vector<Eigen::Vector3d> points);

  [[nodiscard]] int size() const { return static_cast<int>(points_.size()); }
  [[nodiscard]] const Eigen::Vector3d& point(int i) const { return points_[i]; }

  /// Calls `visit(i, distance)` for every point in the closed ball.
  template <class Visit>
  void visit(const Eigen::Vector3d& centre, double radius, const Visit& visit) const {
    if (points_.empty()) return;
    const std::array<int, 3> first = cell_of(centre.array() - radius),
                             last = cell_of(centre.array() + radius);
    for (int z = first[2]; z <= last[2]; ++z)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int x = first[0]; x <= last[0]; ++x) {
          const int cell = (z * cells_[1] + y) * cells_[0] + x;
          for (int k = begin_[cell]; k < begin_[cell + 1]; ++k) {
            const double distance = (points_[entry_[k]] - centre).norm();
            if (distance <= radius) visit(entry_[k], distance);
          }
        }
  }

  struct Nearest {
    int point = -1;                                             ///< -1: there is none
    double distance = std::numeric_limits<double>::infinity();  ///< m
  };
  /// The nearest point; of several the lowest.
  /// @param except  a point that does not count; -1: all do
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& x, int except = -1) const;

 private:
  [[nodiscard]] std::array<int, 3> cell_of(const Eigen::Vector3d& x) const {
    std::array<int, 3> out{};
    for (int k = 0; k < 3; ++k)
      out[k] = static_cast<int>(std::clamp((x[k] - low_[k]) / cell_, 0.0, cells_[k] - 1.0));
    return out;
  }

  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero(), high_ = Eigen::Vector3d::Zero();
  double cell_ = 1;
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<int> begin_;  ///< of each cell in `entry_`; cells + 1
  std::vector<int> entry_;  ///< points
};

}  // namespace geoprior
