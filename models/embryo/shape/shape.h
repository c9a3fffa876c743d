#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::embryo {

/// The geometrical components of the thesis' ontology (2.3).
enum class Primitive { point, line, plane, ovoid, cylinder, duct };

/// A geometrical component in its place on one day. A plain value, in metres.
struct Shape {
  Primitive primitive = Primitive::point;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// Columns: local x, y, z; a rotation. Lines, cylinders and ovoids are long along z, which is a
  /// plane's normal.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// Ovoid: a, b, c along local x, y, z. Cylinder: r, r, half the length with its round caps. Line:
  /// 0, 0, half the length. Plane: half the edge twice, 0.
  Eigen::Vector3d radii = Eigen::Vector3d::Zero();
  /// Ovoid: a and b are scaled by 1 + egg z / c; within [-0.5, 0.5].
  double egg = 0;
  /// Duct: the control points of its centre line, both ends included.
  std::vector<Eigen::Vector3d> points;
  /// Duct: radius at the start and at the end, linear in the arc's length between.
  double radius = 0, end_radius = 0;
  /// Duct: generations of branching of what it drains; a ratio.
  double branchings = 0;
};

/// Whether it bounds a solid: ovoids, cylinders and ducts do, landmarks do not.
bool is_solid(Primitive primitive);

/// Smallest radius (m): of an ovoid its smallest semi-axis, egg or not, of a duct that of its
/// thinner end; of a landmark 0.
double smallest_radius(const Shape& shape);

/// Where a duct is anchored, by coordinates (u, v, w) local to the anchor structure.
///
/// Ovoid: center + R (u a s, v b s, w c) with the egg's scale s = 1 + egg w. Cylinder: center +
/// R (u r, v r, w length/2). Line: center + R (0, 0, w length/2). Plane: center +
/// R (u extent, v extent, 0). Point: its centre. Duct: the point of its centre line at the fraction
/// w of its arc.
/// @throws Error  on a duct without control points
Eigen::Vector3d anchor_point(const Shape& shape, const Eigen::Vector3d& uvw);

}  // namespace geoprior::embryo
