#pragma once

#include <string>
#include <vector>

#include "core/frame.h"
#include "experiments/embryo/scene/scene.h"
#include "solvers/embryo/queries/rows.h"

namespace geoprior::embryo {

/// Rows of one query as texts.
using AnswerRows = std::vector<std::vector<std::string>>;

/// What the viewer asks on a day: of the kidney and the urinary system, or, where an ontology has
/// none, of the first structure with progenitors and of the body.
ViewerQuestion question_of(const EmbryoScene& scene, double day);

/// Answers to all queries of the viewer as a frame: numbers of rows, and what tells their sets
/// apart (FNV-1a of the sorted rows).
Frame answer_frame(double day, std::vector<AnswerRows> answers);

}  // namespace geoprior::embryo
