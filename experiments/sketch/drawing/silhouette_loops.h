#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/sketch/drawing/stroke.h"

namespace geoprior::sketch {

/// An open place of a silhouette: the end of one stroke and the nearest end of another (or its
/// own).
struct SilhouetteGap {
  std::string from, to;  ///< ids
  Eigen::Vector2d end{0, 0}, next{0, 0};
};

/// Silhouettes as closed loops, and the gap that keeps them from being so.
struct SilhouetteLoops {
  std::vector<Stroke> loops;          ///< counter-clockwise; those that were closed come first
  std::optional<SilhouetteGap> gap;   ///< then `loops` is not complete
  std::vector<SilhouetteGap> closed;  ///< gaps that were
};

/// Joins open strokes end to end into closed ones, whichever way each was drawn. From an end the
/// nearest free end is taken, when it is within `snap`; the two meet halfway. Attributes are the
/// first stroke's, ids are joined with "+".
///
/// @param strokes  at least two points each, three when closed
/// @param snap     largest gap that is closed (m)
SilhouetteLoops join_silhouettes(std::span<const Stroke> strokes, double snap);

/// A point where a stroke meets itself other than at the common ends of neighbouring chords. Which
/// one of several: of the first chord that meets another. Exact but for the point's rounding.
/// Chords are compared when their extents along one axis overlap: up to n^2 time for long ones.
std::optional<Eigen::Vector2d> self_crossing(const Stroke& stroke);

}  // namespace geoprior::sketch
