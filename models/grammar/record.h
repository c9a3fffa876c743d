#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frame.h"
#include "core/mesh.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// What is seen and measured of a state: the key points of all elements that are present, and,
/// where it is asked for, their triangles. A baseline that knows no elements moves these.
struct Geometry {
  Eigen::MatrixX3d keys;              ///< one row a key point (m)
  std::vector<int> key_element;       ///< whose it is
  std::vector<int> key_number;        ///< which of the element's
  TriMesh surface;                    ///< of all elements, each with vertices of its own
  std::vector<int> triangle_element;  ///< one a triangle
  std::vector<int> vertex_element;    ///< one a vertex
};

Geometry geometry_of(const Hierarchy& hierarchy, bool with_surface);

/// A frame of the topic. Parts:
///
/// - `elements`: points, the positions of the elements that are present, with arrays `element`,
///   `type`, `parent` (numbers; parent -1: the root), `turn` (x, y, z, w), `parameters` (as many
///   columns as the richest type has, the rest 0), `tagged` (0 or 1);
/// - `keys`: points with arrays `element`, `key`, `type`, `parent`;
/// - `surface`: triangles with the cell arrays `element`, `type`; absent where none was asked for.
///
/// @param geometry  of `hierarchy`, or what a baseline made of it
Frame frame_of(double parameter, const Hierarchy& hierarchy, const Geometry& geometry);

}  // namespace geoprior::grammar
