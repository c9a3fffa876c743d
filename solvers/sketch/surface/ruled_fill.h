#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/surface/ruled_patches.h"

namespace geoprior::sketch {

/// Strip of triangles between two borders, all of whose vertices lie on them. It has no interior
/// vertex, so that it is developable whatever its positions.
struct RuledStrip {
  std::vector<int> node;       ///< of each vertex; a band has its first ruling twice
  Eigen::MatrixX3i triangles;  ///< of vertices; neighbours in the list share an edge
};

/// Strip along the steps of a patch; of the two diagonals of a quadrangle the shorter is taken.
/// Triangles with a repeated node (borders that meet) are left out.
RuledStrip ruled_strip(const CurveNet& net, const RuledPatch& patch,
                       const Eigen::MatrixX3d& positions);

/// Places of the strip's vertices in the plane, by unrolling triangle after triangle: every edge
/// keeps its length, up to round-off.
/// @param positions  of the nodes (m)
/// @return  one row a vertex (m); the first edge lies on the x axis
Eigen::MatrixX2d unroll_strip(const RuledStrip& strip, const Eigen::MatrixX3d& positions);

}  // namespace geoprior::sketch
