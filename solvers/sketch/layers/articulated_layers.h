#pragma once

#include "core/options.h"
#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/layers/layered_body.h"

namespace geoprior::sketch {

void describe(OptionVisitor& v, LayerOptions& options);

/// Circles, bands and hinges; without joint limits (joint_range.h).
///
/// Band j is the frustum whose rear rim is circle j + 1, as it was drawn, about that circle's axis;
/// the first one goes from circle 0 to circle 1 whatever their axes.
/// A band reaches forward to the farthest point of the circle before it and an overlap farther;
/// there its radius is the largest with which it stays below the bands before it: by `clearance`
/// at rest, and by half of that where its strip is turned by up to `free_deg`. Its rivets lie
/// halfway along the overlap, where a line along the mirror plane's normal meets both bands
/// `rivet_margin` inside of their lower borders.
///
/// An overlap that is not given is the largest, up to 95 % of the visible length of the band
/// before, with which
///
/// - such a radius exists, with room for the whole band when it is turned;
/// - the joint turns by `free_deg` either way: the solids do not touch and no gap opens;
/// - the band stays hidden below the one before: behind that one's front rim at rest, of the first
///   band also when it is turned;
/// - the rim of the band before stands off by at most `gape` at rest.
///
/// Where there is none, the last is dropped, and up to half of the visible length is taken, or else
/// more; where there is none either, the angle is made smaller, in quarters; where no quarter of it
/// is left, the band need not be hidden: on a strongly bent body of narrow bands its lower corners
/// look out in front.
///
/// @throws Error  as `drawn_mirror_planes` and `fit_arc_circles`; a layer that does not fit below
///                the one before it (names both strokes)
/// Source: thesis figure 2.14 gives the idea; the construction is ours.
ArticulatedLayers build_layers(const View& view, const LayerOptions& options);

}  // namespace geoprior::sketch
