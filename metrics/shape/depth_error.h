#pragma once

#include <Eigen/Core>

namespace geoprior {

/// What is taken out of a reconstruction's depth before it is compared.
enum class DepthAlignment {
  none,
  offset,            ///< mean difference along the view: an orthographic view cannot know it
  offset_and_scale,  ///< and the factor on depth that fits best: also forgives a wrong tilt of the
                     ///< mirror plane, and a reconstruction with near and far exchanged
};

/// Difference of a reconstruction from the truth, point by point.
struct DepthError {
  double rms = 0, max = 0;  ///< along the view, after the alignment (m)
  double share = 0;         ///< rms over the given length
  double offset = 0;        ///< added to the reconstruction's depth (m)
  double scale = 1;         ///< its depth was multiplied by this first; negative: near was far
  double in_plane_rms = 0;  ///< across the view, where nothing is aligned (m)
};

/// No point is left out, however far off: the errors are those of all points.
///
/// Compares matched points only, so it says nothing of the surface between them. With `none` or
/// `offset` a reconstruction with near and far exchanged, which is the other solution of an
/// orthographic view, counts as wrong; with `offset_and_scale` a reconstruction without any depth
/// costs no more than the truth's own spread, so read `scale` with it. One of constant depth keeps
/// scale 1.
///
/// @param points,truth  n x 3, rows that belong together (m)
/// @param to_eye        direction of depth, not 0
/// @param length        that `share` is of, positive (m)
/// @throws Error        unless both have as many rows, one or more, all finite; on a direction or a
///                      length of 0
DepthError depth_error(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& truth,
                       const Eigen::Vector3d& to_eye, double length,
                       DepthAlignment alignment = DepthAlignment::offset);

}  // namespace geoprior
