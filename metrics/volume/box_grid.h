#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace geoprior {

/// Axis-aligned rectangle in the plane (m).
struct PlanarBox {
  Eigen::Vector2d low, high;
};

/// Smallest box that holds the points.
inline PlanarBox box_of(std::span<const Eigen::Vector2d> points) {
  PlanarBox box{points.front(), points.front()};
  for (const Eigen::Vector2d& p : points) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

/// Closed boxes in the plane, found again by the cells of a uniform grid: about as many cells as
/// boxes, so that boxes of similar size that cover the plane a few times are found in constant
/// time.
///
/// Queries may be asked from several threads at once. Their order depends on the boxes alone.
class BoxGrid {
 public:
  /// @param boxes  at least one; finite
  explicit BoxGrid(std::vector<PlanarBox> boxes);

  [[nodiscard]] const PlanarBox& box(int i) const { return boxes_[i]; }
  /// Side of a cell (m); positive.
  [[nodiscard]] double cell_size() const { return cell_; }

  /// Calls `visit(i)` once for every box that has a point in common with the query.
  template <class Visit>
  void visit(const PlanarBox& query, const Visit& visit) const {
    const std::array<int, 2> first = cell_of(query.low), last = cell_of(query.high);
    for (int y = first[1]; y <= last[1]; ++y) {
      for (int x = first[0]; x <= last[0]; ++x) {
        const int cell = y * columns_ + x;
        for (int k = begin_[cell]; k < begin_[cell + 1]; ++k) {
          const int i = entry_[k];
          const PlanarBox& b = boxes_[i];
          if ((b.low.array() > query.high.array()).any()) continue;
          if ((b.high.array() < query.low.array()).any()) continue;
          // Of the cells in common, the one that holds the corner of the common box reports.
          const std::array<int, 2> corner = cell_of(b.low.cwiseMax(query.low));
          if (corner[0] == x && corner[1] == y) visit(i);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::array<int, 2> cell_of(const Eigen::Vector2d& p) const {
    const double x = (p.x() - low_.x()) / cell_, y = (p.y() - low_.y()) / cell_;
    return {static_cast<int>(std::clamp(x, 0.0, columns_ - 1.0)),
            static_cast<int>(std::clamp(y, 0.0, rows_ - 1.0))};
  }
  template <class Visit>
  void each_cell(const PlanarBox& box, const Visit& visit) const;

  std::vector<PlanarBox> boxes_;
  Eigen::Vector2d low_;
  double cell_ = 1;
  int columns_ = 1, rows_ = 1;
  std::vector<int> begin_;  ///< of each cell in `entry_`; cells + 1
  std::vector<int> entry_;  ///< boxes
};

}  // namespace geoprior
