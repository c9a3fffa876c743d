#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// The borders of a flat mesh, cut at their corners: chains of vertices, each from a corner to the
/// next along the border, both of them in it. A corner is where the border turns by more than 45
/// degrees; a border without one has no stretch.
///
/// @param points  n x 2 (m)
/// @param F       triangles of a manifold with border
std::vector<std::vector<int>> border_stretches(const Eigen::MatrixX2d& points,
                                               const Eigen::MatrixX3i& F);

/// Largest relative difference between such a stretch and the same vertices in space, both measured
/// as circular arcs (`circular_arc`; two points: their distance). For pieces whose edges are arcs
/// and straight lines before and after they are laid flat, as those of frusta are: exact there,
/// where sums over chords differ between the two. A chain that is no arc (off by a millionth of its
/// length) is measured by the arcs through each three of its points.
///
/// @param flat   n x 2 (m)
/// @param space  n x 3, the same vertices on the surface (m)
/// @return       0 without a stretch
/// @throws Error as `circular_arc`
double border_length_error(const Eigen::MatrixX2d& flat, const Eigen::MatrixX3i& F,
                           const Eigen::MatrixX3d& space);

}  // namespace geoprior
