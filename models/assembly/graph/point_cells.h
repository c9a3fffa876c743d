#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace geoprior::assembly {

/// Points in cells of the size of a distance: is there one within it?
class PointCells {
 public:
  PointCells(const std::vector<Eigen::Vector3d>& points, double distance)
      : points_(points), distance_(distance) {
    for (std::size_t i = 0; i < points.size(); ++i) cells_[cell(points[i])].push_back(i);
  }
  [[nodiscard]] bool has_near(const Eigen::Vector3d& x) const {
    const Cell c = cell(x);
    for (int k = 0; k < 27; ++k) {
      const auto found = cells_.find({c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1});
      if (found == cells_.end()) continue;
      for (const std::size_t i : found->second)
        if ((points_[i] - x).norm() <= distance_) return true;
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cell(const Eigen::Vector3d& x) const {
    return {static_cast<std::int64_t>(std::floor(x.x() / distance_)),
            static_cast<std::int64_t>(std::floor(x.y() / distance_)),
            static_cast<std::int64_t>(std::floor(x.z() / distance_))};
  }

  const std::vector<Eigen::Vector3d>& points_;
  double distance_;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

}  // namespace geoprior::assembly
