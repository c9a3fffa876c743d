#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/drawing/mirror_plane.h"

namespace geoprior::sketch {

/// Depths of a point and of its mirror image.
struct PairDepths {
  double z = 0;
  double z_image = 0;
};

/// Depths of a pair of symmetric points from their places p, p' in the picture. P' - P is parallel
/// to the normal n and the middle lies in the plane:
///
///     z' - z = n_z (p' - p).n_xy / |n_xy|^2,   n_z (z + z') = 2 offset - n_xy.(p + p').
///
/// Exact when p' - p is parallel to n_xy; otherwise the part across n_xy is ignored.
PairDepths pair_depths(const MirrorPlane& plane, const Eigen::Vector2d& p,
                       const Eigen::Vector2d& image);

/// A drawn pair, with its ends put onto borders.
struct SymmetricPair {
  std::string id;  ///< of the stroke
  Eigen::Vector2d point{0, 0};
  Eigen::Vector2d image{0, 0};
  bool in_plane = false;             ///< both ends are one point, of the mirror plane
  std::vector<CurvePoint> point_at;  ///< all curves through the end's place: several at junctions
  std::vector<CurvePoint> image_at;  ///< as `point_at`
};

/// Direction across the pairs in the picture: |across.(p' - p)| is what a pair misses the normal
/// by.
Eigen::Vector2d across_pairs(const MirrorPlane& plane);

/// The symmetric pairs of a view, on the borders of the panels that they name. A pair whose ends
/// lie within a quarter of `net.snap` marks a point of the mirror plane.
///
/// Ends that were drawn with noise slide along their borders to where the pair runs along the
/// normal: by the least s, s' that leave (s^2 + s'^2) + 10 miss^2 least, since a faired border is
/// sure to about a tenth of the variance of a single point; by three deviations at most, and not
/// at ends of borders or junctions.
///
/// @param tolerance  of the direction of a pair, and of two partners of one point (share of the
///                   drawing's diagonal)
/// @param noise      standard deviation of a drawn coordinate (m)
/// @throws Error     when there is none; when no border has the panels that a pair names; when an
///                   end lies on no border; when a pair runs across the
///                   plane's normal, or one point has two partners (names them and the residual)
std::vector<SymmetricPair> read_symmetric_pairs(const View& view, const CurveNet& net,
                                                const MirrorPlane& plane, double tolerance,
                                                double noise = 0);

}  // namespace geoprior::sketch
