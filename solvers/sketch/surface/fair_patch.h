#pragma once

#include <Eigen/Core>
#include <string>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Surface of least mean curvature through a closed border.
///
/// The inside of the border, seen along its mean normal, is meshed (constrained Delaunay with a
/// hexagonal grid of points), and the inner vertices solve L x = 0 with the cotangent Laplacian L
/// of the surface itself, found by a few solves (sparse Cholesky) from that of the flat layout:
/// H n = L x / 2 vanishes, the discrete minimal surface of Pinkall and Polthier 1993. The
/// fourth-order system L M^-1 L x = 0 of Botsch and Kobbelt 2004b needs tangents along the border,
/// which a drawing does not give; with positions alone and Lx = 0 at the border, its solution is
/// that of L x = 0. On a plane border the patch is plane.
///
/// @param border   n x 3, in order; no two equal (m)
/// @param spacing  of the inner points (m)
/// @param solves   with the surface's own Laplacian, after that of the layout
/// @param where    names the border in errors
/// @return         the first n vertices are the border's; triangles run counter-clockwise seen from
///                 where the border does
/// @throws Error   on less than three points, or a border that crosses itself seen along its normal
/// Source: thesis 2.1.3, third step.
TriMesh fair_patch(const Eigen::MatrixX3d& border, double spacing, int solves,
                   const std::string& where);

/// The inside of a closed border that is plane, up to drawing noise, without inner vertices: it can
/// be laid flat whatever the noise. Other conditions as for `fair_patch`.
TriMesh flat_patch(const Eigen::MatrixX3d& border, const std::string& where);

}  // namespace geoprior::sketch
