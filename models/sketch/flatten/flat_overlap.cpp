#include "models/sketch/flatten/flat_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace geoprior::sketch {
namespace {

using FlatCorners = std::array<Eigen::Vector2d, 3>;

struct FlatBox {
  Eigen::Vector2d low, high;
};

/// Largest gap between two triangles along the normals of the first one's edges (m); negative: how
/// far they would have to be moved to part them that way.
double gap_across_edges(const FlatCorners& p, const FlatCorners& q) {
  double widest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2d edge = p[(k + 1) % 3] - p[k];
    const double length = edge.norm();
    if (!(length > 0)) continue;
    Eigen::Vector2d normal(edge.y() / length, -edge.x() / length);
    if (normal.dot(p[(k + 2) % 3] - p[k]) > 0) normal = -normal;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& corner : q) nearest = std::min(nearest, normal.dot(corner - p[k]));
    widest = std::max(widest, nearest);
  }
  return widest;
}

bool triangles_overlap(const FlatCorners& p, const FlatCorners& q, double depth) {
  return gap_across_edges(p, q) < -depth && gap_across_edges(q, p) < -depth;
}

/// Squares of a grid and the triangles whose boxes meet them.
class TriangleGrid {
 public:
  TriangleGrid(const std::vector<FlatBox>& boxes, const FlatBox& all) : low_(all.low) {
    double size = 0;
    for (const FlatBox& box : boxes) size += (box.high - box.low).maxCoeff();
    size /= static_cast<double>(boxes.size());
    const Eigen::Vector2d extent = all.high - all.low;
    const double most = std::sqrt(4.0 * static_cast<double>(boxes.size()));
    size = std::max(size, extent.maxCoeff() / (most + 1));
    inverse_ = size > 0 ? 1 / size : 0;
    columns_ = cell(extent.x()) + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * (cell(extent.y()) + 1));
    for (int t = 0; t < std::ssize(boxes); ++t) {
      visit(boxes[t], [&](std::vector<int>& in) { in.push_back(t); });
    }
  }

  template <class Visitor>
  void visit(const FlatBox& box, const Visitor& visitor) {
    const int x0 = cell(box.low.x() - low_.x()), x1 = cell(box.high.x() - low_.x());
    const int y0 = cell(box.low.y() - low_.y()), y1 = cell(box.high.y() - low_.y());
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) visitor(cells_[y * columns_ + x]);
    }
  }

 private:
  [[nodiscard]] int cell(double x) const { return static_cast<int>(x * inverse_); }

  Eigen::Vector2d low_;
  double inverse_ = 0;
  int columns_ = 1;
  std::vector<std::vector<int>> cells_;
};

}  // namespace

std::vector<std::array<int, 2>> overlapping_triangles(const Eigen::MatrixX2d& points,
                                                      const Eigen::MatrixX3i& triangles,
                                                      double depth) {
  std::vector<std::array<int, 2>> pairs;
  const std::size_t m = triangles.rows();
  if (m == 0) return pairs;
  std::vector<FlatCorners> corners(m);
  std::vector<FlatBox> boxes(m);
  FlatBox all{points.row(triangles(0, 0)).transpose(), points.row(triangles(0, 0)).transpose()};
  for (std::size_t t = 0; t < m; ++t) {
    for (int k = 0; k < 3; ++k) corners[t][k] = points.row(triangles(t, k)).transpose();
    boxes[t] = {corners[t][0].cwiseMin(corners[t][1]).cwiseMin(corners[t][2]),
                corners[t][0].cwiseMax(corners[t][1]).cwiseMax(corners[t][2])};
    all = {all.low.cwiseMin(boxes[t].low), all.high.cwiseMax(boxes[t].high)};
  }
  TriangleGrid grid(boxes, all);
  std::vector<int> near;
  for (int t = 0; t < static_cast<int>(m); ++t) {
    near.clear();
    grid.visit(boxes[t], [&](const std::vector<int>& in) {
      near.insert(near.end(), std::upper_bound(in.begin(), in.end(), t), in.end());
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const int other : near) {
      if (triangles_overlap(corners[t], corners[other], depth)) pairs.push_back({t, other});
    }
  }
  return pairs;
}

}  // namespace geoprior::sketch
