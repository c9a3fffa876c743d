#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// Rounded studs that keep apart on a smooth closed surface.
struct SurfaceSetOptions {
  enum class Shape { blob, torus };
  Shape shape = Shape::blob;
  double width = 2.4, depth = 2, height = 1.8;  ///< of the surface, along x, y, z (m)
  double spacing = 0.15;                        ///< least distance of studs of full size (m)
};
void describe(OptionVisitor& v, SurfaceSetOptions& options);

/// Numbers of the parameters of an "item".
struct ItemParameter {
  static constexpr int kSize = 0;      ///< 0 … 1
  static constexpr int kRadius = 1;    ///< half the spacing (m)
  static constexpr int kTriangle = 2;  ///< of the surface, on which it sits
  static constexpr int kB0 = 3, kB1 = 4;
  static constexpr int kCandidate = 5;  ///< 1: there only where there is room
};

/// Height of an item's tip over its size times its radius.
inline constexpr double kItemHeight = 0.85;

/// A place on a triangle mesh that goes where the mesh goes: b0 p0 + b1 p1 + (1 - b0 - b1) p2.
struct TrianglePlace {
  int triangle = 0;
  double b0 = 0, b1 = 0;
};

Eigen::Vector3d on_triangle(std::span<const Eigen::Vector3d> points,
                            const Eigen::MatrixX3i& triangles, const TrianglePlace& place);

/// The turn that takes the frame of a triangle before to the one it has now: first axis along
/// p1 - p0, third along the normal. Of a triangle without area no turn.
Eigen::Quaterniond triangle_turn(std::span<const Eigen::Vector3d> before,
                                 std::span<const Eigen::Vector3d> now,
                                 const Eigen::MatrixX3i& triangles, int triangle);

/// The place of the surface that is nearest to a point.
TrianglePlace nearest_place(std::span<const Eigen::Vector3d> points,
                            const Eigen::MatrixX3i& triangles, const Eigen::Vector3d& x);

/// A surface with studs at rest: all of size 1, none of the candidates is there, distances are at
/// least the spacing.
///
/// Types "surface-set", the root, whose points are the vertices of the surface, and "item", with
/// the parameters above. Its frame: origin on the surface, z along the normal; key points: its
/// centre, on the surface, and its tip. Children of the root in order of priority.
/// @throws Error  naming the option: out of its range
Hierarchy make_surface_set(const SurfaceSetOptions& options, std::uint64_t seed);

}  // namespace geoprior::grammar
