#pragma once

#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::sketch {

/// How much a neighbour counts in the mean of a vertex's neighbours.
enum class NeighbourWeight {
  umbrella,   ///< all the same; also evens out the triangles
  cotangent,  ///< cotangents of the mesh that is given, those below zero as zero; keeps triangles
};

/// Low-pass filter of a mesh that does not shrink (Taubin, A Signal Processing Approach to Fair
/// Surface Design, 1995):
///
///   x <- x + lambda L x,  x <- x + mu L x,  (L x)_i = sum_j w_ij (x_j - x_i) / sum_j w_ij
///
/// with lambda > 0 > mu. One double step multiplies what varies at the frequency k (eigenvalue of
/// -L, 0 ... 2) by (1 - lambda k)(1 - mu k): by 1 at k = 0 and at the pass frequency
/// 1 / lambda + 1 / mu (0.113 with the defaults), by slightly more between them, by less above.
struct TaubinOptions {
  double lambda = 0.5;
  double mu = -0.53;
  int double_steps = 50;
  NeighbourWeight weight = NeighbourWeight::umbrella;
  bool fixed_border = true;
};
void describe(OptionVisitor& v, TaubinOptions& options);

/// Positions after smoothing (n x 3); a vertex without triangles stays.
///
/// Vertices of ridges move along them: with two of their edges by the two neighbours there; at
/// their ends and where they branch they stay.
///
/// @param mesh    triangle mesh, open or closed
/// @param ridges  edges of the mesh that stay sharp
/// @throws Error  for lambda not above 0, mu not below -lambda, or a negative number of steps
/// Source: Taubin 1995; thesis 2.1.2.
Eigen::MatrixX3d taubin_smoothed(const TriMesh& mesh, const TaubinOptions& options = {},
                                 const std::vector<Edge>& ridges = {});

}  // namespace geoprior::sketch
