#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace geoprior::paper {

/// The flat shape that a sheet is cut from: a simple polygon in the plane, counter-clockwise,
/// metres. Every sheet is an isometric image of its pattern, or should be.
struct Pattern {
  std::vector<Eigen::Vector2d> border;
};

/// Most corners of a pattern: every pair of edges is looked at.
inline constexpr int kMostCorners = 10000;

/// Axis-aligned rectangle centred at the origin.
Pattern rectangle_pattern(double width, double height);

/// Regular polygon with `corners` corners on the circle of this radius about the origin.
Pattern disc_pattern(double radius, int corners);

/// Throws Error naming corner or edge unless the border is finite, has three corners that are not
/// collinear, no corner twice, no spike, does not cross or touch itself and runs counter-clockwise.
/// `where` names its source (a file and key).
void require_simple(const Pattern& pattern, const std::string& where);

/// Signed area (m^2), positive for counter-clockwise.
double signed_area(const Pattern& pattern);

/// Longest distance of two corners (m).
double diameter(const Pattern& pattern);

/// Larger side of the bounding box (m): the "width" that tolerances refer to.
double width(const Pattern& pattern);

/// True inside, and within `tolerance` (m) of the border.
bool contains(const Pattern& pattern, const Eigen::Vector2d& p, double tolerance = 0);

/// Point of the border nearest to `p`, and where it lies.
struct BorderPoint {
  Eigen::Vector2d point;
  int edge = 0;  ///< from corner `edge` to the next
  double t = 0;  ///< 0 … 1 along that edge
  double distance = 0;
};
BorderPoint nearest_on_border(const Pattern& pattern, const Eigen::Vector2d& p);

}  // namespace geoprior::paper
