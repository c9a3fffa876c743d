#pragma once

#include <string>
#include <vector>

#include "core/frame.h"

namespace geoprior::embryo {

/// Rows of one query as texts.
using AnswerRows = std::vector<std::vector<std::string>>;

/// Answers to all queries of the viewer as a frame: numbers of rows, and what tells their sets
/// apart (FNV-1a of the sorted rows).
Frame answer_frame(double day, std::vector<AnswerRows> answers);

}  // namespace geoprior::embryo
