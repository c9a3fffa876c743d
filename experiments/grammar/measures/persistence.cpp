#include "experiments/grammar/measures/persistence.h"

#include <algorithm>

namespace geoprior::grammar {

void PersistenceMeter::remember(const RecordedState& state, int element) {
  Kept& kept = kept_[element];
  kept.then.reset();
  if (const RecordedElement* e = state.find(element)) kept.then = *e;
  kept.lost = kept.lost || !kept.then;
}

void PersistenceMeter::compare(const RecordedState& state) {
  constexpr double kSameDistance = 1e-9;  // m
  compared_ = compared_ || !kept_.empty();
  for (auto& [number, kept] : kept_) {
    const auto now = kept.then ? kept_element(state, *kept.then) : std::nullopt;
    if (!now) {
      kept.lost = true;
      continue;
    }
    distance_ = std::max(distance_.value_or(0), now->distance);
    parameter_ = std::max(parameter_.value_or(0), now->parameter);
    if (now->distance > kSameDistance || now->parameter != 0) kept.lost = true;
  }
}

std::optional<double> PersistenceMeter::lost() const {
  if (!compared_) return std::nullopt;
  return static_cast<double>(std::count_if(kept_.begin(), kept_.end(),
                                           [](const auto& entry) { return entry.second.lost; }));
}

}  // namespace geoprior::grammar
