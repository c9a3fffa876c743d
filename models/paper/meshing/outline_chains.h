#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/paper/sheet/pattern.h"

namespace geoprior::paper {

/// Collects the vertices: points closer than the tolerance are one.
class PointSet {
 public:
  explicit PointSet(double tolerance) : tolerance_(tolerance) {}
  int add(const Eigen::Vector2d& p) {
    for (int i = 0; i < std::ssize(points_); ++i) {
      if ((points_[i] - p).norm() <= tolerance_) return i;
    }
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }
  [[nodiscard]] const std::vector<Eigen::Vector2d>& points() const { return points_; }

 private:
  double tolerance_;
  std::vector<Eigen::Vector2d> points_;
};

/// Points on the segment a b, in order.
std::vector<int> points_along(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& a,
                              const Eigen::Vector2d& b, double tolerance);

/// Vertices round border and holes in order, of the points in the set and of those added where two
/// are more than `longest` apart (m). Corners of the pattern must be in the set.
std::vector<std::vector<int>> border_chains(const Pattern& pattern, double longest,
                                            double tolerance, PointSet& set);

/// Vertices along the edges of the cuts, pair by pair, under the same conditions.
std::vector<Eigen::Vector2i> cut_segments(const Pattern& pattern, double longest, double tolerance,
                                          PointSet& set);

}  // namespace geoprior::paper
