#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "experiments/details/drawing/drawn_details.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

/// Vertices of the border of a hole, about. Chosen for pictures.
inline constexpr int kHoleSegments = 40;

struct CutSurface {
  DrawnDetails drawn;          ///< the surface with holes; `detail`: of the border vertices
  std::vector<double> radius;  ///< of the hole of each anchor (m); 0: not cut
};

/// Holes cut into the surface: for each detail the disc of geodesic radius weight x radius is taken
/// away. What remains is a manifold mesh with one more border a hole.
///
/// Holes never touch: where two discs overlap (or nearly), the overlap is taken from both radii,
/// more from the smaller one,
///   r_i = R_i - o R_j^2 / (R_i^2 + R_j^2),   o = R_i + R_j - 0.85 d_ij,
/// so that a hole that begins to open next to a large one changes nothing at a jump. A hole that
/// would reach a border of the surface, another hole over a ridge or a fold, or around a part
/// thinner than itself, is shrunk until what is cut out is a disc of its own. What is left below
/// 0.04 x radius is not cut.
///
/// @param radius  of a hole of weight 1 (m)
CutSurface cut_holes(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                     std::span<const DrawnAnchor> anchors, double radius);

}  // namespace geoprior::details
