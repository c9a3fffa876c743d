#include "experiments/embryo/measures/answers.h"

#include <algorithm>

#include "experiments/embryo/frames/recorded.h"

namespace geoprior::embryo {

std::optional<double> answer_rows(const EmbryoScene& /*scene*/, const Frame& frame) {
  const FrameTable* answers = frame.find_table(recorded::kAnswers);
  if (answers == nullptr) return std::nullopt;
  return answers->rows.col(1).sum();
}

std::optional<double> answers_differing(const EmbryoScene& /*scene*/, const Frame& frame,
                                        const Frame& reference) {
  const FrameTable* mine = frame.find_table(recorded::kAnswers);
  const FrameTable* others = reference.find_table(recorded::kAnswers);
  if (mine == nullptr || others == nullptr) return std::nullopt;
  const Eigen::Index queries = std::min(mine->rows.rows(), others->rows.rows());
  double differing =
      static_cast<double>(std::max(mine->rows.rows(), others->rows.rows()) - queries);
  for (Eigen::Index q = 0; q < queries; ++q)
    if (mine->rows.row(q) != others->rows.row(q)) ++differing;
  return differing;
}

}  // namespace geoprior::embryo
