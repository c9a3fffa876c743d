#pragma once

#include <Eigen/Core>
#include <span>

#include "models/sketch/flatten/flat_triangles.h"

namespace geoprior::sketch {

struct SymmetricDirichletOptions {
  int iterations = 200;     ///< most Newton steps
  double tolerance = 1e-9;  ///< it stops when the energy falls by less than this, relative to it
};

struct SymmetricDirichletReport {
  int iterations = 0;
  double energy = 0;  ///< over the area: 2 for an isometry
};

/// Lowers the symmetric Dirichlet energy of a map to the plane that turns no triangle over; none
/// will be turned over.
///
///   E(z) = sum_t area_t (|J_t|^2 + |J_t^-1|^2) / 2 = sum_t area_t (s1^2 + s2^2 + s1^-2 + s2^-2) /
///   2
///
/// grows without bound as a triangle loses its area. Newton steps with the Hessian of every
/// triangle made semi-definite in closed form: with J_t v = a v + b conj(v) the singular values are
/// |a| + |b| and |a| - |b|, E depends on |a| and |b| alone, and of the four eigenvalues only the
/// one of a's turn can be negative. A step goes at most 0.9 of the way to the first triangle that
/// would lose its area (the root of a quadratic), then back until the energy falls enough (Armijo).
///
/// A triangle without height in space is given 1e-4 of its longest edge.
///
/// @param z       n places; every triangle counter-clockwise; replaced
/// @throws Error  when a triangle is turned over at first (names it)
/// Source: Smith and Schaefer 2015 (energy, step); Smith, de Goes, Kim 2019 (eigenvalues); see also
/// Rabinovich, Poranne, Panozzo, Sorkine-Hornung 2017.
SymmetricDirichletReport lower_symmetric_dirichlet(std::span<const FlatTriangle> triangles,
                                                   const Eigen::MatrixX3i& F, Eigen::VectorXcd& z,
                                                   const SymmetricDirichletOptions& options);

}  // namespace geoprior::sketch
