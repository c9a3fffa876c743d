#pragma once

#include <Eigen/Core>

#include "core/geometry/curvature_fit.h"

namespace geoprior {

/// Stiffness of a thin isotropic plate.
struct PlateStiffness {
  double membrane = 0;       ///< E h / (1 - nu^2) (N/m)
  double bending = 0;        ///< D = E h^3 / (12 (1 - nu^2)) (N m)
  double poisson_ratio = 0;  ///< nu
  double grain = 0;          ///< direction of the fibres in the pattern (rad)
  double along = 1;          ///< bending stiffness along the fibres over that across them
};

/// (1 - nu) |S|^2 + nu (tr S)^2 of a symmetric tensor with components S_uu, S_uv, S_vv: a plate's
/// energy per area is half its stiffness times this form of its strain or curvature.
double plate_form(double uu, double uv, double vv, double poisson_ratio);

/// The same of a plate that bends `along` times as stiffly along its fibres: (along - 1) (g'S g)^2
/// more, g their direction.
double plate_form(double uu, double uv, double vv, const PlateStiffness& plate);

/// Elastic energy of stretching (J), St. Venant-Kirchhoff: with G = (F'F - I)/2 of each triangle's
/// map F from the pattern to space, sum of A C/2 ((1 - nu) |G|^2 + nu (tr G)^2), C = E h / (1 -
/// nu^2).
///
/// Of the mesh, not of the surface behind it: a coarse mesh locks and shows stretch where a fine
/// one bends.
///
/// @param pattern,x  n x 2, n x 3 (m)
/// @throws Error     on a triangle without area in the pattern (names it)
double membrane_energy(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                       const Eigen::MatrixX3i& triangles, const PlateStiffness& plate);

/// Elastic energy of bending (J): sum of A D/2 ((1 - nu) |S|^2 + nu (tr S)^2) with S the shape
/// operator that the dihedral angles about a triangle give (core/geometry/curvature_fit.h) minus
/// its rest curvature.
///
/// @param fit              of the pattern and the triangles
/// @param x                n x 3 (m)
/// @param rest_curvature   m x 3, S_uu, S_uv, S_vv (1/m)
/// @throws Error           unless `rest_curvature` has a row a triangle
double bending_energy(const CurvatureFit& fit, const Eigen::MatrixX3d& x,
                      const Eigen::MatrixX3d& rest_curvature, const PlateStiffness& plate);

/// Kinetic energy (J) of a velocity that is linear on each triangle, exactly integrated; mass per
/// area of the pattern.
double kinetic_energy(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& velocity,
                      const Eigen::MatrixX3i& triangles, double area_density);

}  // namespace geoprior
