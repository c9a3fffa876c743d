#pragma once

#include <optional>
#include <vector>

#include "experiments/paper/measures.h"
#include "metrics/tear_path.h"

namespace geoprior::paper {

/// The tears of a frame: paths in the pattern, cuts that the sheet begins with left out.
struct TornSheet {
  std::vector<TearPath> paths;     ///< of each tear what has grown, from where it began to grow
  std::vector<TearPath> outlines;  ///< of each, with the cut it began with
};
/// Absent when the method records no tears. @throws Error  when the part is not as documented
std::optional<TornSheet> torn_sheet(const Frame& frame);

/// What a sheet torn by two hands is measured by; absent values have no meaning in the scene.
struct TearMeasures {
  double length = 0;  ///< grown, of all tears (m)
  int parts = 0;      ///< that the sheet has fallen into
  Value drift;        ///< focal_drift of the longest tear, of two hands
  Value deviation;    ///< of its chord from the bisector at its start (deg), of two hands
  Value bow;          ///< path_bow of the longest tear
  Value onset_force;  ///< largest handle force over the closed form, of the last frame without
                      ///< growth, of two hands
};
/// Absent when the method records no tears.
std::optional<TearMeasures> tear_measures(const SheetFrame& f);

/// Hausdorff distance of the longest tears in the pattern, the shorter one's length of both (m).
Value tear_path_distance(const SheetFrame& f, const SheetFrame& reference);

}  // namespace geoprior::paper
