#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace geoprior {

/// A piece of a pattern and the surface it is to become, both at true scale.
struct FlatPiece {
  Eigen::MatrixX2d points;     ///< n x 2 (m)
  Eigen::MatrixX3d x;          ///< n x 3, where they are on the surface (m)
  Eigen::MatrixX3i triangles;  ///< m x 3, counter-clockwise in the plane
};

/// The pieces of a pattern that holds them all, ascending by number, each with its own points.
/// @param points     n x 2 (m)
/// @param x          n x 3, where the points are on the surface (m)
/// @param triangles  m x 3
/// @param piece      the number of the piece of each triangle, m of them
/// @throws Error     unless there are as many rows of `points` as of `x`, and as many numbers as
///                   triangles
std::vector<FlatPiece> pieces_apart(const Eigen::MatrixX2d& points, const Eigen::MatrixX3d& x,
                                    const Eigen::MatrixX3i& triangles, std::span<const int> piece);

/// Singular values s1 >= s2 of the linear map of each triangle from the surface to the plane,
/// without any rescaling: both 1 where the material keeps its lengths. m x 2; a triangle without
/// area on the surface gets 1, 1.
/// @throws Error  unless there are as many rows of `points` as of `x`
Eigen::MatrixX2d flattening_singular_values(const FlatPiece& piece);

/// Deviations that `stretch_share` and `area_share` count.
inline constexpr std::array<double, 3> kFlatteningBounds{0.01, 0.02, 0.05};

/// How far a pattern is from its surface; means, shares and quantiles by area on the surface.
struct FlatteningSummary {
  double stretch_mean = 1;  ///< of max(s1, 1 / s2)
  double stretch_p95 = 1;   ///< that 95 % of the area stay under
  double stretch_max = 1;
  double area_ratio = 1;  ///< area of the pattern over that of the surface, turned-over triangles
                          ///< counted as area
  double area_ratio_min = 1, area_ratio_max = 1;     ///< of a triangle, s1 s2
  double angle_ratio_mean = 1, angle_ratio_max = 1;  ///< of s1 / s2; 1 for a conformal triangle
  /// Of the map from the plane to the surface, singular values 1 / s2 and 1 / s1: root of the mean
  /// of (s1^-2 + s2^-2) / 2, and the largest 1 / s2.
  double sander_l2 = 1, sander_linf = 1;
  std::array<double, 3> stretch_share{1, 1, 1};  ///< with max(s1, 1 / s2) - 1 within each bound
  std::array<double, 3> area_share{1, 1, 1};     ///< with |s1 s2 - 1| within each bound
  int flips = 0;          ///< triangles that are turned over or have no area in the plane; exact
  int self_overlaps = 0;  ///< pairs of triangles of one piece that overlap; exact
  double self_overlap_area = 0;  ///< sum of the areas that those pairs have in common (m^2)
};

/// Of all pieces together.
///
/// Lengths are compared at true scale: a pattern that is similar to the surface but larger counts
/// as stretched, unlike in the parameterisation literature, where Sander's values are taken after
/// rescaling to equal area. Singular values are accurate to 1e-8 and count as 1e-6 when they are
/// smaller, so that a collapsed triangle gives a huge value, not an infinite one.
///
/// Says how well each triangle keeps its lengths, not how well the triangles follow a smooth
/// surface: a coarse polyhedron can be flattened perfectly. It knows nothing of what is sewn to
/// what (metrics/isometry/seam_lengths.h), and nothing of the material: cloth that gives 5 % along
/// one thread counts the same as paper. Triangles with no area on the surface carry no weight, but
/// may be flips.
///
/// @throws Error  on no triangle with an area on the surface, unequal numbers of rows, or a
///                coordinate that is not finite
/// Source of L2 and Linf: Sander, Snyder, Gortler and Hoppe 2001, section 3.
FlatteningSummary flattening(std::span<const FlatPiece> pieces);

/// Two pieces of a layout that lie on each other.
struct PieceOverlap {
  int first = 0, second = 0;  ///< ascending
  double area = 0;            ///< in common (m^2), where neither piece overlaps itself
};

/// All such pairs, ascending; exact, touching is no overlap. Only `points` and `triangles` are
/// looked at. Distances between pieces (the width of a cut, an allowance) are not seen.
std::vector<PieceOverlap> piece_overlaps(std::span<const FlatPiece> laid_out);

}  // namespace geoprior
