#pragma once

#include <span>

#include "core/options.h"
#include "models/grammar/maps/spatial_map.h"
#include "models/grammar/record.h"

namespace geoprior::grammar {

struct RigidAsPossibleOptions {
  int iterations = 30;
  double controls = 0.1;
};
void describe(OptionVisitor& v, RigidAsPossibleOptions& options);

/// As-rigid-as-possible deformation of every connected piece of every element's surface.
///
/// Vertices nearest to key points of the element are held where the map takes them, at least four
/// key points, spread evenly over their order; the others follow by minimising
/// sum_ij w_ij |(x_i' - x_j') - R_i (x_i - x_j)|^2 with cotangent weights, by local and global
/// steps from the best rigid motion. A piece that is not manifold, or has only degenerate
/// triangles, makes the best rigid motion to where the map takes its vertices. A key point that is
/// a vertex goes with it, another by the best affine map of the element's vertices (rigid where
/// these are flat); where the element draws nothing, by the map.
///
/// It keeps the shape of the pieces, roughly, and nothing between them. Pieces none of whose held
/// vertices is moved by the map stay, bit for bit.
/// @param moved  one number an element: those with 0 stay, bit for bit; empty: all move
/// @throws Error  `moved` that is too short
/// Source: Sorkine and Alexa 2007; CGAL 5.5, Triangulated Surface Mesh Deformation.
Geometry rigid_as_possible(const Geometry& before, const SpatialMap& map,
                           const RigidAsPossibleOptions& options = {},
                           std::span<const char> moved = {});

}  // namespace geoprior::grammar
