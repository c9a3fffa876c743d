#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace geoprior {

/// Side of the line from `a` to `b` on which `c` lies: +1 left, -1 right, 0 on it. Exact.
int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// True when the closed segments a b and c d have a point in common. Exact.
bool segments_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d);

/// Twice the signed area of the triangle 0, a, b: positive when it is counter-clockwise. Rounded,
/// so that its sign is no substitute for `orientation`.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Angle by which `a` turns to the direction of `b` (rad), in [-pi, pi], positive
/// counter-clockwise.
inline double signed_angle(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(cross(a, b), a.dot(b));
}

/// Constrained Delaunay triangulation of the ground between closed loops.
///
/// @param points    n x 2, no two equal
/// @param loops     closed chains of points: the outer one counter-clockwise, holes clockwise, so
///                  that the ground is on the left of each
/// @param segments  pairs of points in the ground: edges of the result, as those of the loops are.
///                  Segments do not cross, and no point lies inside a segment.
/// @return          counter-clockwise triangles, in an order that the input alone decides
/// @throws Error    when two points coincide or two segments cross (names them)
/// Source: CGAL 5.5, 2D Triangulations.
Eigen::MatrixX3i constrained_delaunay(const Eigen::MatrixX2d& points,
                                      const std::vector<std::vector<int>>& loops,
                                      const std::vector<Eigen::Vector2i>& segments);

/// Constrained Delaunay triangulation of the inside of a closed chain of segments.
///
/// @param points    n x 2, no two equal
/// @param segments  pairs of points: edges of the result; they must enclose the inside, and others
///                  may lie in it. Segments do not cross, and no point lies inside a segment.
/// @return          counter-clockwise triangles, in an order that the input alone decides
/// @throws Error    when two points coincide or two segments cross (names them)
/// Source: CGAL 5.5, 2D Triangulations.
Eigen::MatrixX3i constrained_delaunay(const Eigen::MatrixX2d& points,
                                      const std::vector<Eigen::Vector2i>& segments);

}  // namespace geoprior
