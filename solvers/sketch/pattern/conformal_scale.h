#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior::sketch {

/// Logarithm u of the scale that a conformal map to the plane has, with lengths kept at the border:
///
///   L u = K,  u = 0 at the border,
///
/// L the cotangent matrix (1/2 u' L u is the Dirichlet energy) and K the angle defects. u is what
/// the curvature adds up to on the way from the border: positive where the surface bulges (the
/// pattern is too small there), negative where it has too much border. Its extremes are where a cut
/// takes out most: the place of a cone.
///
/// @param piece   with a border
/// @throws Error  when it has none
/// Source: Ben-Chen, Gotsman and Bunin 2008, Conformal flattening by curvature prescription and
/// metric scaling.
Eigen::VectorXd conformal_scale(const TriMesh& piece);

/// Angle defects 2 pi - (sum of angles) at interior vertices (rad), 0 at the border.
Eigen::VectorXd angle_defects(const TriMesh& piece);

}  // namespace geoprior::sketch
