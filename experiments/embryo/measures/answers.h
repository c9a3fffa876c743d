#pragma once

#include "core/frame.h"
#include "experiments/embryo/scene/scene.h"

namespace geoprior::embryo {

/// Rows of the viewer's queries against those of the reference variant.
struct AnswerMeasures {
  double rows = 0;       ///< of all queries
  double differing = 0;  ///< queries whose rows, as sets, are others than the reference's
};
/// Absent where a frame has no answers.
std::optional<AnswerMeasures> answer_measures(const EmbryoScene& scene, const Frame& frame,
                                              const Frame& reference);

}  // namespace geoprior::embryo
