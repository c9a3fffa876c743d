#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "models/assembly/graph/part_type.h"

namespace geoprior::assembly {

/// A body of closed pieces, outward oriented. Vertices are shared where the surface is smooth and
/// doubled along edges of more than 30 degrees, so that vertex normals shade both as they are.
/// Pieces may lie in each other.
struct Body {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<Box> boxes;  ///< one a primitive; a swept one has one for each straight segment

  [[nodiscard]] TriMesh mesh() const;
};

/// Adds a body where `pose` puts it.
void append(Body& body, const Body& piece, const Pose& pose);

/// All of these throw Error, naming no place, on sizes below 1e-6 m and on those that do not fit
/// together.

/// A box about the origin. @param round  radius of its edges, below half of the smallest side
Body box_body(const Eigen::Vector3d& size, double round);

/// A cylinder or, where the radius at the top differs, a cone about the z axis, from -length / 2 to
/// length / 2; its rims are rounded.
Body cylinder_body(double radius, double top_radius, double length, double round);

Body sphere_body(double radius);

/// A closed outline of points (r, z), r >= 0, turned about the z axis.
Body lathe_body(std::span<const Eigen::Vector2d> outline);

/// A closed outline in the x-y plane, either way round, from z = 0 to z = height; the edges along z
/// are rounded.
Body prism_body(std::span<const Eigen::Vector2d> outline, double height, double round);

/// Measures of what is swept along a poly-line (m).
struct SweptShape {
  double width = 0;   ///< of a channel: inside
  double height = 0;  ///< of a channel: depth of the groove
  double wall = 0;    ///< of a channel: beside and below the groove
  double offset = 0;  ///< to the left of the poly-line
  double round = 0;   ///< radius of the edges along the poly-line
};

/// A bar with a groove in it, which has a round bottom: the poly-line runs at the bottom of the
/// groove. The section stands upright and is mitred at the corners.
/// @throws Error  for a poly-line of fewer than two points, with a vertical or an empty segment, or
///                with a turn of more than 120 degrees
Body channel_body(std::span<const Eigen::Vector3d> points, const SweptShape& shape);

/// A bar with a rectangular section; the poly-line runs along the middle of its underside.
/// @throws Error  as above
Body rail_body(std::span<const Eigen::Vector3d> points, const SweptShape& shape);

}  // namespace geoprior::assembly
