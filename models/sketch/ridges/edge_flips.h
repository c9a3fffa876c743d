#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>

namespace geoprior::sketch {

/// Triangles a b c and b a d beside the edge a b, which a flip makes into c d b and d c a.
struct EdgeDiamond {
  int left, right;
  int a, b, c, d;
  std::array<int, 4> around;  ///< triangles across b c, c a, a d, d b; -1: none
};

/// Flips those edges of a mesh that are wanted, one after the other in their order. What a flip
/// touches is left alone, since the connectivity is that of the beginning: for all that can be
/// flipped, passes are made until there is none. The mesh stays a manifold.
/// @param F          n x 3, of a manifold, open or closed
/// @param is_wanted  asked of every edge that can be flipped; its diamond is that of the triangles
///                   as they are then
/// @return           number of flips
int flip_edges(Eigen::MatrixX3i& F, const std::function<bool(const EdgeDiamond&)>& is_wanted);

}  // namespace geoprior::sketch
