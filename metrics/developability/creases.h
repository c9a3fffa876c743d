#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "metrics/spacing/pattern_grid.h"

namespace geoprior {

/// Creases, facets and singular points of a sheet, read off the normals at the points of a grid in
/// its pattern: the same detector on every mesh.
struct CreaseOptions {
  double grid_spacing = 2.5e-3;  ///< m; folds are looked for between points two spacings apart
  double fold_angle = 0.3490658503988659;  ///< 20 degrees: what makes a fold a crease (rad)
  double smallest_facet = 1e-4;            ///< facets under it are dust (m^2)
  double ring_radius = 0.01;               ///< of the ring about a singular point (m)
  double cone_energy = 0.05;               ///< what makes a point singular (rad)
  double cone_distance = 0.02;             ///< singular points closer than this are one (m)
};

/// A sheet seen through the grid.
struct GriddedSheet {
  PatternGrid grid;
  Eigen::MatrixX3d normals;  ///< of each triangle, unit
};

/// @param pattern    n x 2 (m)
/// @param x          n x 3 (m)
/// @param triangles  m x 3
GriddedSheet gridded_sheet(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3d& x,
                           const Eigen::MatrixX3i& triangles, double grid_spacing);

/// Length of the creases in the pattern (m): where the normal turns by more than `fold_angle`
/// between points 3.5 to 5.6 mm apart (at the default spacing).
///
/// By Cauchy and Crofton: the length of curves is half the integral over all straight lines of the
/// number of crossings; here the lines have eight directions and are chains of links between grid
/// points. Links of a chain that turn the same way, with at most one between them, cross one
/// crease: a fold that a mesh spreads over a few edges counts once.
///
/// A straight fold comes out within 3 % at any angle to the grid; folds about four links apart lose
/// a tenth where they meet. A smooth bend counts, in part, from a radius of 14 mm down. A mesh that
/// carries a fold without edges along it really has a zigzag there, and it is measured: at 60
/// degrees 1.08 of the fold's length with edges of 4.4 mm, 1.4 with 10 mm.
///
/// Source: Boykov and Kolmogorov 2003, Computing geodesics and minimal surfaces via graph cuts.
double crease_length(const GriddedSheet& sheet, const CreaseOptions& options = {});

/// Areas in the pattern (m^2) of the facets: connected sets of grid points whose neighbours'
/// normals differ by no more than `fold_angle`; those under `smallest_facet` are left out. In the
/// order of their lowest grid point.
std::vector<double> facet_areas(const GriddedSheet& sheet, const CreaseOptions& options = {});

/// A point of the pattern about which the sheet is neither a plane, nor a fold, nor a cylinder.
struct DetectedCone {
  Eigen::Vector2d position;  ///< in the pattern (m)
  double energy = 0;         ///< rad
};

/// Apexes of d-cones, e-cones and vertices of folds.
///
/// The energy at a grid point is the smallest eigenvalue of the integral of n n' around a ring in
/// the pattern, as `hinge_energy` has it for a star (on a mesh coarser than the ring the two agree
/// at a vertex): zero for planes, folds and cylinders. Singular points are its largest values
/// within `cone_distance`, above `cone_energy`. Points that the ring about them does not fit into
/// the pattern are not looked at, and a largest value next to those is no apex but the flank of
/// something at the border.
/// Two apexes closer than `cone_distance` count once; a sharply curved crease can show apexes along
/// it; the slope of a cone must exceed about 0.13.
std::vector<DetectedCone> detect_cones(const GriddedSheet& sheet,
                                       const CreaseOptions& options = {});

}  // namespace geoprior
