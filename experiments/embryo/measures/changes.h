#pragma once

#include <optional>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/scene/scene.h"
#include "testbed/frame_sequence.h"

namespace geoprior::embryo {

/// A sequence under a disease against that of the reference variant, which has none.
struct ChangeMeasures {
  double absent = 0;   ///< structures that the reference has some day, and this one never
  double altered = 0;  ///< others that differ in a bit on some day
  std::optional<double> absent_errors, altered_errors;  ///< against the list; absent without one
  std::optional<double> other_side;  ///< changed ones of the side that the disease is not of
};

/// Structures are compared by the bytes of their triangles' corners and of their centre lines: how
/// a method comes by them is not looked at. Absent without a reference.
std::optional<ChangeMeasures> change_measures(const EmbryoScene& scene,
                                              const FrameSequence& frames);

/// A day against that of the reference variant; absent where one has no body.
struct DifferenceMeasures {
  std::optional<double> state;    ///< largest difference of recorded shapes, over the body's length
  std::optional<double> surface;  ///< largest distance of surfaces, over the body's length
  double unmatched = 0;           ///< structures that only one of both has a surface of
};
std::optional<DifferenceMeasures> difference_measures(const EmbryoScene& scene, const Frame& frame,
                                                      const Frame& reference);

}  // namespace geoprior::embryo
