#pragma once

#include "core/frame.h"
#include "experiments/embryo/scene/scene.h"

namespace geoprior::embryo {

/// Rows of all queries of the viewer; absent where a frame has no answers.
std::optional<double> answer_rows(const EmbryoScene& scene, const Frame& frame);

/// Queries whose rows, as sets, are others than those of the reference variant; absent where one of
/// both has no answers.
std::optional<double> answers_differing(const EmbryoScene& scene, const Frame& frame,
                                        const Frame& reference);

}  // namespace geoprior::embryo
