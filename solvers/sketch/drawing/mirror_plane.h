#pragma once

#include <Eigen/Core>

#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// Plane of symmetry n.P = offset of what is seen in one view (x right, y up, z towards the eye).
struct MirrorPlane {
  Eigen::Vector3d normal{1, 0, 0};  ///< unit; z >= 0
  double offset = 0;                ///< m
};

/// The plane as drawn, and its other reading: the shape mirrored in depth (Necker's cube) has the
/// same picture, so that a drawing alone cannot tell the two apart.
struct MirrorPlanes {
  MirrorPlane chosen;
  MirrorPlane other;
};

/// Image of a point in the plane.
Eigen::Vector3d mirrored(const MirrorPlane& plane, const Eigen::Vector3d& point);

/// Signed distance of a point to the plane (m).
double signed_distance(const MirrorPlane& plane, const Eigen::Vector3d& point);

/// Plane spanned by two vectors that are orthogonal in space, from their orthographic images a, b.
///
/// Lengths in space are taken as |a3| = ratio |b3|. With c = a.b and d = |ratio b|^2 - |a|^2 (b
/// scaled first) the depths obey a_z b_z = -c and a_z^2 - b_z^2 = d, hence
/// a_z^2 = (d + sqrt(d^2 + 4 c^2)) / 2. The larger of the two depths is computed so and the other
/// from the product, which keeps its digits when it vanishes. One sign is free: it is chosen so
/// that the head of `a` points towards the eye when the stroke of `a` is marked `front` (and away
/// when `back`); where a lies in the picture's plane, the mark of `b` decides.
///
/// Depth is measured from the tail of `a`, through which the plane passes at z = 0: the picture
/// says nothing of the distance to the eye.
///
/// @param a, b   plane vectors, from their first to their last point
/// @param ratio  |a3| / |b3| in space
/// @throws Error on a vector without length; on parallel vectors (mirror plane seen edge on: pairs
///               lie in the picture's plane and their depth is not determined); on a plane that
///               faces the eye (pairs coincide in the picture). Names the strokes.
/// Source: thesis 2.1.3 draws the two vectors; the closed form is ours.
MirrorPlanes mirror_planes(const Stroke& a, const Stroke& b, double ratio = 1);

/// The planes from the vectors that a view names "sym-a" and "sym-b".
/// @throws Error  when one of them is missing or drawn twice; as `mirror_planes`
MirrorPlanes drawn_mirror_planes(const View& view, double ratio = 1);

/// The plane from the direction in which pairs are drawn and the right angle between the two
/// vectors, whatever the ratio of their lengths in space.
///
/// With u the direction of n_xy and n = (u cos f, sin f), a vector v of the plane has the depth
/// -(u.v) cot f, and a3.b3 = 0 gives cot^2 f = -a.b / ((u.a) (u.b)). The side to which the plane
/// leans is that of `drawn`. Where the vectors do not tell (the quotient is not positive), or no
/// pair has a length, the plane is `drawn`.
MirrorPlane plane_from_pairs(const View& view, const MirrorPlane& drawn);

/// Standard deviation of the logarithm of |a3| / |b3| in the plane from pairs, of ends that are off
/// by `noise` in each coordinate: of the pairs' common direction, and of the two lengths.
double spread_of_ratio(const View& view, const MirrorPlane& drawn, double noise);

/// Frame of the object in the view, from the chosen plane: rows are its normal, the direction of
/// sym-a in space, and the direction orthogonal to both.
/// @throws Error  when sym-a is missing
Eigen::Matrix3d drawn_object_frame(const View& view, const MirrorPlane& plane);

}  // namespace geoprior::sketch
