#pragma once

#include <Eigen/Core>
#include <span>

#include "core/mesh.h"
#include "metrics/developability/surface_front.h"

namespace geoprior {

/// How a pair-correlation function is estimated. Lengths are in units of the spacing given.
struct PairCurveOptions {
  double reach = 3;        ///< largest distance r
  int bins = 30;           ///< radii at which g is given: the middles of as many equal intervals
  double bandwidth = 0.1;  ///< sigma of the Gaussian kernel
  int sources = 2000;      ///< details from which distances are measured, evenly spread over the
                           ///< rows; all when there are not more
};

/// Pair-correlation function g(r) of points on a surface: how many others a point has at distance
/// r, over how many it would have if they lay there independently. 1 everywhere for independent
/// uniform points, 0 below the radius of a Poisson-disk pattern, peaks for a grid.
struct PairCurve {
  Eigen::VectorXd radius;  ///< in units of the spacing
  Eigen::VectorXd g;       ///< 1 at radii that no two points of the surface are apart
  Eigen::VectorXd error;   ///< standard error of g for independent points; somewhat larger (by a
                           ///< tenth on an animal's body) where annuli differ from place to place
  double step = 0;         ///< between radii
  int sources = 0;
};

/// What counts.
struct PairCurveMask {
  std::span<const double>
      weights{};                   ///< of the details, >= 0: 0 and 1 for visibility; empty: all 1
  std::span<const char> region{};  ///< a flag a triangle, for patterns on a part of the surface:
                                   ///< details and area elsewhere do not count; empty: all
};

/// Estimates g with distances along the surface (`SurfaceFront`):
///
///   g(r) = sum_i w_i sum_{j != i} w_j k(r - d_ij) / sum_i w_i rho_i A_i(r),
///   A_i(r) = integral over the surface of k(r - d(i, x)) dx,  rho_i = (sum_j w_j - w_i) / area,
///
/// k a Gaussian. A_i is the area of the annulus about detail i that the surface has, so neither its
/// curvature nor its borders show in g; a ratio of sums needs no annulus to be large. For
/// independent uniform points the estimate is unbiased for any number of them.
///
/// In units of the spacing, patterns of one kind have one curve, however large the surface: compare
/// curves of a motion in the unit of its first frame. A detail pattern of varying density has g
/// above 1 by the variance of that density: compare it with itself, not with 1.
///
/// Cost: proportional to sources x (triangles + details within the reach); triangles larger than
/// the kernel count as several. The same bytes for any number of threads.
///
/// @param surface  any triangle mesh (m)
/// @param details  places on it
/// @param unit     spacing (m), positive: that of the original pattern
/// @throws Error   on options, a unit or weights that make no sense, a place on no triangle, or
///                 fewer than two details that count
/// Source: the planar estimator is that of Oeztireli and Gross 2012; the annulus on the surface
/// replaces 2 pi r.
PairCurve pair_curve(const TriMesh& surface, std::span<const SurfacePoint> details, double unit,
                     const PairCurveOptions& options = {}, const PairCurveMask& mask = {});

/// L1 distance of two curves: integral of |g_a - g_b| over r, in units of the spacing.
/// @throws Error  when they have different radii
double pair_curve_distance(const PairCurve& a, const PairCurve& b);

/// Distances between curves of independent patterns of one process: what a distance means that
/// is no larger.
struct PairNoise {
  double mean = 0;     ///< the noise floor: expected distance of a resample to the original
  double largest = 0;  ///< among those made
};
/// @param resamples  at least two curves of the process, seeds of their own; the original may be
/// one
/// @throws Error     with fewer than two, or as `pair_curve_distance`
PairNoise pair_curve_noise(std::span<const PairCurve> resamples);

}  // namespace geoprior
