#include "metrics/volume/box_grid.h"

#include <cmath>
#include <utility>

namespace geoprior {

template <class Visit>
void BoxGrid::each_cell(const PlanarBox& box, const Visit& visit) const {
  const std::array<int, 2> first = cell_of(box.low), last = cell_of(box.high);
  for (int y = first[1]; y <= last[1]; ++y) {
    for (int x = first[0]; x <= last[0]; ++x) visit(y * columns_ + x);
  }
}

BoxGrid::BoxGrid(std::vector<PlanarBox> boxes) : boxes_(std::move(boxes)) {
  PlanarBox all = boxes_.front();
  for (const PlanarBox& b : boxes_) {
    all.low = all.low.cwiseMin(b.low);
    all.high = all.high.cwiseMax(b.high);
  }
  low_ = all.low;
  const Eigen::Vector2d size = all.high - all.low;
  const auto n = static_cast<double>(boxes_.size());
  // Square cells: as many as boxes in the area, and no more than boxes along a side.
  cell_ = std::max(std::sqrt(size.x() * size.y() / n), size.maxCoeff() / n);
  if (!(cell_ > 0)) cell_ = 1;
  columns_ = static_cast<int>(size.x() / cell_) + 1;
  rows_ = static_cast<int>(size.y() / cell_) + 1;
  begin_.assign(columns_ * rows_ + 1, 0);
  for (const PlanarBox& b : boxes_) each_cell(b, [&](int cell) { ++begin_[cell + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  entry_.resize(begin_.back());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (int i = 0; i < std::ssize(boxes_); ++i)
    each_cell(boxes_[i], [&](int cell) { entry_[next[cell]++] = i; });
}

}  // namespace geoprior
