#include "experiments/embryo/measures/answers.h"

#include "experiments/embryo/frames/recorded.h"

namespace geoprior::embryo {

std::optional<AnswerMeasures> answer_measures(const EmbryoScene& /*scene*/, const Frame& frame,
                                              const Frame& reference) {
  const FrameTable* mine = frame.find_table(recorded::kAnswers);
  const FrameTable* others = reference.find_table(recorded::kAnswers);
  if (mine == nullptr || others == nullptr) return std::nullopt;
  AnswerMeasures m;
  m.rows = mine->rows.col(1).sum();
  const Eigen::Index queries = std::min(mine->rows.rows(), others->rows.rows());
  m.differing = static_cast<double>(std::max(mine->rows.rows(), others->rows.rows()) - queries);
  for (Eigen::Index q = 0; q < queries; ++q)
    if (mine->rows.row(q) != others->rows.row(q)) ++m.differing;
  return m;
}

}  // namespace geoprior::embryo
