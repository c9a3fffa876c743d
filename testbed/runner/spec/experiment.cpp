#include "testbed/runner/spec/experiment.h"

#include <algorithm>

#include "core/error.h"

namespace geoprior {

const StudySpec* study_of(const ClaimSpec& claim, const std::vector<StudySpec>& studies) {
  const auto found = std::find_if(studies.begin(), studies.end(), [&](const StudySpec& study) {
    return "study:" + study.name == claim.metric;
  });
  return found == studies.end() ? nullptr : &*found;
}

Direction direction_of(Comparison comparison) {
  switch (comparison) {
    case Comparison::less_equal:
    case Comparison::less:
      return Direction::lower_is_better;
    case Comparison::greater_equal:
    case Comparison::greater:
      return Direction::higher_is_better;
    case Comparison::equal:
      break;
  }
  return Direction::none;
}

bool null_is_yardstick(const ClaimSpec& claim) {
  return claim.null && claim.of == claim.null && claim.factor == 1 && claim.offset == 0 &&
         !claim.of_reduce;
}

const Topic& topic_of(const Experiment& experiment, const std::vector<Topic>& topics) {
  for (const Topic& topic : topics) {
    if (topic.name == experiment.topic) return topic;
  }
  throw Error("unknown topic '" + experiment.topic + "'", experiment.file.string());
}

}  // namespace geoprior
