#pragma once

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/mirror_plane.h"
#include "solvers/sketch/hidden/completed_view.h"

namespace geoprior::sketch {

/// What hidden parts of borders are guessed from.
enum class Completion {
  all,       ///< parallel copies, ellipses, mirror images and smooth continuation
  mirror,    ///< mirror images and smooth continuation
  parallel,  ///< parallel copies, ellipses and smooth continuation
  none,      ///< nothing is guessed: flat and fair panels with an open border are left out
};

/// Completes the borders of a drawing that shows only what can be seen (thesis 2.1.3).
///
/// A drawing with strokes of kind occlusion says itself what is hidden, and is left as it is; so is
/// one in which nothing is guessed. Otherwise:
///
/// 1. Stretches of one border are put together (`seen_borders`).
/// 2. What a border lacks comes from a whole border that a drawn ruling joins it to, as its
///    parallel copy (`ParallelCopy`: parts of cones and cylinders are bounded by parallel planes,
///    thesis 2.1.3); that includes the ellipse of a circular rim from that of a visible one. What
///    is seen of a rim that is smaller than its neighbour, and on the copy but for noise, is put
///    there. Its pairs come along where none is drawn.
/// 3. A rim whose ends are both covered, and which is seen for more than five ninths of an ellipse
///    or for 130 degrees of it between the silhouettes of its own panel, goes round: the ellipse
///    through what is seen. Its pairs would say where it is symmetric, but their ends are single
///    points: with noise they lead astray.
/// 4. A border with two pairs is continued by its mirror image.
/// 5. Stretches that are still apart are joined by a cubic; a flat panel whose borders are still no
///    loop is closed by a straight line.
///
/// Guesses agree with what is seen to two snapping distances, or are not made; a border is
/// continued by more than one snapping distance, or not. Whatever is guessed
/// is marked by an occlusion in the result. It cannot guess what neither a visible neighbour nor
/// symmetry shows: such ends stay, and are listed.
///
/// Whatever is drawn, borders joined by a ruling of which one is the other's copy, to half a
/// percent of the diagonal, are listed: they lie in parallel planes.
///
/// @param snap   share of the drawing's diagonal within which ends meet
/// @param noise  standard deviation of a drawn coordinate (m): ends meet within three of it too,
///               and borders are copies to two of it
CompletedView complete_borders(const View& view, const MirrorPlane& plane, double snap,
                               Completion completion, double noise = 0);

}  // namespace geoprior::sketch
