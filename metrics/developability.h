#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace geoprior {

/// Angle defect 2 pi - (sum of angles) of every interior vertex (rad): zero where the mesh can be
/// laid flat.
///
/// Angles come from edge lengths alone, so the result does not change under isometries, and it is
/// blind to a surface that is crumpled isometrically: read it beside `hinge_energy`.
///
/// @param mesh  manifold triangle mesh, n vertices
/// @return      n values; 0 at the border and for vertices without triangles
/// Source: thesis 2.1.1; Stein, Grinspun and Crane 2018, section 3.
Eigen::VectorXd angle_defect(const TriMesh& mesh);

/// Hinge energy of every interior vertex (rad): the smallest eigenvalue of the sum over its
/// triangles of theta_f n_f n_f', theta_f the angle at the vertex and n_f the unit normal.
///
/// Zero exactly when the normals of the star lie in one plane: then two flat pieces, or rulings
/// that are parallel to first order, meet in a line through the vertex ("hinge"), and a mesh all of
/// whose vertices are hinges is a developable surface without singular points. A vertex with zero
/// angle defect that more than one fold line crosses (a d-cone, a vertex of origami) is not zero.
/// Dimensionless, the same under scaling; on a smooth surface of curvature K the sum over the
/// vertices tends to a multiple of the integral of |K| that depends on the layout of the mesh.
///
/// @return  n values; 0 at the border and for vertices without triangles
/// Source: Stein, Grinspun, Crane, Developability of Triangle Meshes, 2018, equation of E^lambda.
Eigen::VectorXd hinge_energy(const TriMesh& mesh);

/// Share of the area at interior vertices (a third of each triangle about them) whose triangles'
/// normals all lie within `tolerance` (rad) of one great circle, fitted by the plane of the
/// smallest eigenvalue of `hinge_energy`: how thin the Gauss image is. 1 for a developable surface;
/// 1 also for a mesh without interior vertices.
///
/// Depends on the mesh: on a finer one the normals of a star lie closer together, so even a sphere
/// becomes thin.
///
/// @throws Error  on a tolerance that is not positive
double gauss_image_thinness(const TriMesh& mesh, double tolerance);

/// The values above over a whole mesh.
struct DevelopabilitySummary {
  double angle_defect_mean = 0;  ///< mean of |defect| over the interior vertices (rad)
  double angle_defect_max = 0;   ///< largest |defect| (rad)
  double hinge_energy_sum = 0;
  double hinge_energy_max = 0;
  double thinness = 1;  ///< within one degree
};
DevelopabilitySummary developability(const TriMesh& mesh);

}  // namespace geoprior
