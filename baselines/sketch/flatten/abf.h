#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior::sketch {

/// The angles of a flat layout that are nearest to those of a surface.
struct AbfAngles {
  Eigen::MatrixX3d angle;  ///< m x 3, at each corner (rad)
  int iterations = 0;
  double constraint = 0;  ///< largest violation (rad; wheels: of the logarithm)
  bool converged = false;
};

/// Angle-based flattening by ABF++.
///
///   min 1/2 sum_i ((alpha_i - beta_i) / beta_i)^2
///   subject to  alpha_1 + alpha_2 + alpha_3 = pi            in every triangle,
///               sum of alpha = 2 pi                         at every inner vertex,
///               sum log sin alpha_next - log sin alpha_last = 0   around it (its wheel closes),
///
/// beta the angles of the surface, scaled at inner vertices to add up to 2 pi. Newton's method on
/// the Lagrangian: angles, then the triangles' multipliers are eliminated, which leaves a symmetric
/// system with two unknowns per inner vertex, that only neighbours share. The logarithm of the
/// paper's product constraint has diagonal second derivatives, so that the full Hessian is diagonal
/// and kept (the paper leaves them out); an entry below a tenth of the objective's own is raised to
/// that. Steps stay within nine tenths of the way to an angle of 0 or pi.
///
/// @param disc    one border, every vertex in a triangle
/// @throws Error  unless the mesh is a disc
/// Source: Sheffer, Lévy, Mogilnitsky, Bogomyakov, ABF++: Fast and Robust Angle Based Flattening,
/// 2005, sections 2 and 3; Zayer, Lévy, Seidel, Linear Angle Based Parameterization, 2007 (the
/// logarithm).
AbfAngles abf_angles(const TriMesh& disc);

/// The layout of those angles, by least squares on z_last - z_0 = (sin alpha_next / sin alpha_last)
/// exp(i alpha_0) (z_next - z_0) in every triangle, which is a least squares conformal map (ABF++,
/// section 4) and exact when the angles meet their constraints. Scaled to the surface's area.
///
/// @return        n x 2 (m)
/// @throws Error  unless the mesh is a disc
Eigen::MatrixX2d flatten_abf(const TriMesh& disc);

}  // namespace geoprior::sketch
