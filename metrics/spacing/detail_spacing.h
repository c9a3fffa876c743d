#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace geoprior {

/// Edges of a detail mesh M_d that say how far details are apart: those with a triangle on both
/// sides, neither of which has a ghost. Near a border the ghosts decide which edges there are.
///
/// Where two points are joined twice (an intrinsic triangulation around a thin neck), the pair
/// comes twice. Loops are left out.
///
/// @param triangles  m x 3, one orientation
/// @param ghosts     a flag a point; empty: none
/// @return           pairs (lower, higher), ascending
/// @throws Error     on an index without a flag (names the triangle)
std::vector<std::pair<int, int>> edges_among_details(const Eigen::MatrixX3i& triangles,
                                                     std::span<const char> ghosts);

/// Lengths of the edges of M_d in one frame. All zero without edges.
struct DetailSpacing {
  int edges = 0;
  double mean = 0;                  ///< m
  double variation = 0;             ///< standard deviation / mean
  double smallest = 0;              ///< m
  std::array<double, 9> deciles{};  ///< 10 %, 20 %, … 90 % of the edges are at most as long (m)
  double outside = 0;               ///< share of edges outside 0.7 … 1.4 of `reference`
};

/// Spacing of details as chords of `edges_among_details`. Give the triangulation of the visible
/// details to measure what one sees: new details of weight 0 flatter the spacing of all.
///
/// The mean alone misleads where the pattern is not uniform: read it beside `pair_curve`.
///
/// @param positions  n x 3 (m)
/// @param reference  mean of the original (m), for `outside`; 0: the mean of this frame
DetailSpacing detail_spacing(const Eigen::MatrixX3d& positions, const Eigen::MatrixX3i& triangles,
                             std::span<const char> ghosts, double reference = 0);

/// Relative changes (now - original) / original, signed.
struct SpacingChange {
  double mean = 0;
  std::array<double, 9> deciles{};
};
/// @throws Error  when the original has no spacing
SpacingChange spacing_change(const DetailSpacing& original, const DetailSpacing& now);

/// The largest change over a motion.
struct WorstChange {
  double change = 0;  ///< signed: of the mean edge, where its magnitude is largest
  int frame = 0;      ///< the first with it
};
/// @param frames  the first is the original
/// @throws Error  without frames, or when the first has no spacing
WorstChange worst_mean_change(std::span<const DetailSpacing> frames);

/// Number of details over the number that would keep the original density everywhere: 1 is right.
///
/// That number is the integral of the original density times the growth of the area, taken at the
/// original details: the sum over them of area now / area then of the triangle of the surface that
/// held them. For a uniform growth it is the original number times the factor.
///
/// @param count       details now
/// @param faces       triangle of the surface under each original detail
/// @param areas_then  of the triangles (m^2)
/// @param areas_now   as many (m^2)
/// @throws Error      without original details, on a face that is none or that had no area
double density_ratio(int count, std::span<const int> faces, const Eigen::VectorXd& areas_then,
                     const Eigen::VectorXd& areas_now);

}  // namespace geoprior
