#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

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

/// How the two values are spread over the interior vertices that count. All are 0, and the share 1,
/// when none does.
struct DevelopabilitySpread {
  int vertices = 0;              ///< that count
  double defect_sum = 0;         ///< of |angle defect| (rad); 4 pi or more on a closed genus 0
  double defect_max = 0;         ///< rad
  double defect_median = 0;      ///< rad
  double defect_p90 = 0;         ///< that 90 % of the vertices stay under (rad)
  double defect_flat_share = 1;  ///< of the vertices with |angle defect| below `kFlatDefect`
  double hinge_sum = 0;          ///< of `hinge_energy` (rad)
  double hinge_max = 0;
  double hinge_median = 0;
};

/// |angle defect| below which a vertex counts as flat (rad).
inline constexpr double kFlatDefect = 0.005;

/// Sum, largest value and quantiles over the vertices: the sum alone says little, because curvature
/// that gathers in few vertices leaves it as it is while the median falls.
///
/// Vertices are counted, not their area: values of two meshes compare at equal edge lengths only
/// (on a smooth surface a single defect falls with the area of its star, the sum does not). The
/// signs of defects are lost, and a crumpled star without defect is seen by the hinge energy alone.
/// What is left out hides what it holds: give the numbers with and without the mask.
///
/// @param left_out  per vertex, true for those that may bend freely (seams, folds); empty: none.
///                  Border vertices never count.
/// @throws Error    when `left_out` is neither empty nor as long as the mesh has vertices
DevelopabilitySpread developability_spread(const TriMesh& mesh,
                                           const std::vector<bool>& left_out = {});

/// How near the normals of a whole panel, points of the unit sphere weighted by area, lie to one
/// circle of it.
///
/// Great circle: plane of the smallest eigenvalue of E[n n'], the normals of a general cylinder.
/// Small circle: the same about the mean, E[(n - m)(n - m)'], the normals of a general cone.
struct GaussImage {
  /// Smallest over middle eigenvalue of E[n n']: 0 for a cylinder, 1 for a spherical cap.
  double great_circle_thinness = 0;
  /// Of E[(n - m)(n - m)']: 0 for a cone and a cylinder. It takes a small spherical cap for a flat
  /// cone, since the cap's image is a nearly flat disc: (1 - c) / (2 (2 + c)) for a cap of half
  /// angle acos(c).
  double small_circle_thinness = 0;
  /// Root mean square of the normals' angles from that great circle (rad).
  double great_circle_rms = 0;
  /// From a small circle: of the circles about the four axes at hand (the great circle's, and the
  /// eigenvectors about the mean) the best one, so not the best of all. Does not take a cap for a
  /// cone as readily: a quarter of the half angle.
  double small_circle_rms = 0;
  Eigen::Vector3d axis{0, 0, 1};  ///< of that small circle, unit
  double half_angle = 0;          ///< mean angle of the normals to `axis` (rad)
};

/// Blind to how the normals are laid out over the panel: a panel may be creased across its rulings
/// and still have a thin image, and one of several cylinders is not thin though each of them is.
/// The ratios depend on the extent of the image, and mean little for a nearly flat panel with
/// noise, whose ratio is that of the noise; one whose normals lie within about 1e-5 rad of a point
/// has thinness 0, and of two points too (a fold) about the mean.
///
/// @param triangles  of the panel; empty: all
/// @throws Error     when none of them has an area
/// Source: thesis 2.1.2 (equation 2.1 is the small circle of a star); cones as in Decaudin et al.
/// 2006.
GaussImage gauss_image(const TriMesh& mesh, std::span<const int> triangles = {});

/// Area of some triangles of a mesh (m^2).
double panel_area(const TriMesh& mesh, std::span<const int> triangles);

/// Gauss images of the panels of a surface: means by
/// area.
struct PanelImages {
  double great_circle_thinness = 0;
  double small_circle_thinness = 0;
  double circle_rms = 0;  ///< of the nearer of each panel's two circles (rad)
};
/// @param panels  triangles of each, rows of F
/// @throws Error  without panels; as `gauss_image`
PanelImages panel_images(const TriMesh& mesh, std::span<const std::vector<int>> panels);

}  // namespace geoprior
