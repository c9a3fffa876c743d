#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior::sketch {

struct CgalArapOptions {
  double lambda = 1000;     ///< 0: as similar as possible, large: as rigid as possible
  int iterations = 50;      ///< most local and global steps
  double tolerance = 1e-6;  ///< relative change of the energy at which it stops
};

/// As-rigid-as-possible parameterisation of CGAL, by default in its default settings.
///
/// It starts from mean-value coordinates on a circle and mends triangles that are turned over by a
/// pass of its own. Fifty steps from there do not always reach an isometry: a frustum of 288
/// triangles is left with edges 2 % wrong, and is exact to 1e-13 after a thousand. Not scaled: the
/// energy asks for true lengths.
///
/// Both take triangles without area off the border (three points of one line, as remeshing leaves
/// them at straight borders), by which their weights would divide, and put their corners back on
/// that line.
///
/// @return        n x 2 (m)
/// @throws Error  unless the mesh is a disc, and with CGAL's message when it gives up
/// Source: CGAL 5.5, Triangulated Surface Mesh Parameterization; Liu et al. 2008.
Eigen::MatrixX2d flatten_cgal_arap(const TriMesh& disc, const CgalArapOptions& options = {});

/// Least squares conformal map of CGAL with the two pins that it chooses, scaled to the surface's
/// area.
///
/// @return        n x 2 (m)
/// @throws Error  unless the mesh is a disc, and with CGAL's message when it gives up
/// Source: CGAL 5.5, Triangulated Surface Mesh Parameterization; Lévy et al. 2002.
Eigen::MatrixX2d flatten_cgal_lscm(const TriMesh& disc);

}  // namespace geoprior::sketch
