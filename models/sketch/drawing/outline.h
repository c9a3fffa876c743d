#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::sketch {

/// A simple closed polygon, counter-clockwise: the silhouette of a view. Answers nearest-point
/// queries through a grid of its segments.
class Outline {
 public:
  Outline() = default;
  /// @param points  at least three, no two consecutive ones equal; turned counter-clockwise
  /// @throws Error  on fewer points or no area
  explicit Outline(std::vector<Eigen::Vector2d> points);

  struct Nearest {
    Eigen::Vector2d point{0, 0};   ///< on the outline
    Eigen::Vector2d normal{0, 0};  ///< outward there, unit: at a corner halfway between its sides
    double distance = 0;           ///< signed, negative inside (m)
    double arc_length = 0;         ///< of `point` from the first point, counter-clockwise (m)
  };
  [[nodiscard]] Nearest nearest(const Eigen::Vector2d& x) const;

  [[nodiscard]] const std::vector<Eigen::Vector2d>& points() const { return points_; }
  [[nodiscard]] double length() const { return arc_.back(); }
  /// Arc length at a point of the polygon (m).
  [[nodiscard]] double arc_length(int point) const { return arc_[point]; }
  [[nodiscard]] Eigen::Vector2d at(double arc_length) const;
  /// Arc lengths of its corners, where it turns by more than 30 degrees, ascending (m).
  [[nodiscard]] std::vector<double> corners() const;
  /// Those of them that point outward.
  [[nodiscard]] std::vector<double> convex_corners() const;
  /// Corners of the box: lowest and highest coordinates.
  [[nodiscard]] const Eigen::Vector2d& lowest() const { return lowest_; }
  [[nodiscard]] const Eigen::Vector2d& highest() const { return highest_; }
  [[nodiscard]] double diagonal() const { return (highest_ - lowest_).norm(); }

 private:
  [[nodiscard]] int cell(const Eigen::Vector2d& x, int axis) const;
  void fill_grid();
  [[nodiscard]] std::vector<double> corners_that(bool (*count)(double turn)) const;
  [[nodiscard]] Nearest on_segment(int segment, const Eigen::Vector2d& x) const;

  std::vector<Eigen::Vector2d> points_;
  std::vector<Eigen::Vector2d> sides_;  ///< outward normal of each segment, unit
  std::vector<double> arc_;             ///< one more than points
  Eigen::Vector2d lowest_{0, 0}, highest_{0, 0};
  double spacing_ = 1;  ///< of the grid (m)
  int columns_ = 0, rows_ = 0;
  std::vector<int> begin_, segment_;  ///< segments that pass a cell, in compressed rows
};

}  // namespace geoprior::sketch
