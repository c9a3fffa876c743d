#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "models/sketch/drawing/stroke.h"

namespace geoprior::sketch {

/// What was changed of a drawn stroke so that it could be read.
struct StrokeRepair {
  std::string id;
  std::string what;          ///< "lies along 'b', and is left out"
  Eigen::Vector2d at{0, 0};  ///< in the view
  double moved = 0;          ///< how far, or what length was cut off (m)
};

/// Where two open strokes, or the ends of one, cross near their ends, both end there.
/// @param near  half of how far from an end a crossing is sought (m)
std::vector<StrokeRepair> cut_overshoots(std::vector<Stroke>& strokes, double near);

/// Takes double lines out of silhouettes that were drawn by hand in several strokes, so that they
/// can be joined end to end:
///
/// - a stroke that lies along another one is left out, the shorter of two;
/// - where the end of a stroke goes on beside the beginning of the next one, or of its own, it is
///   cut off.
///
/// It cannot tell two sides of a part that is thinner than `near` from a line that was drawn twice.
/// @param strokes  silhouettes of one view
/// @param near     that is taken for the same place (m)
std::vector<StrokeRepair> cut_double_strokes(std::vector<Stroke>& strokes, double near);

}  // namespace geoprior::sketch
