#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/embryo/measures/organs.h"

namespace geoprior::embryo {
namespace {

/// Days of a sequence, each cut up when it is first asked for.
class Days {
 public:
  explicit Days(const FrameSequence& frames) : frames_(frames) {}
  const RecordedDay& operator[](std::size_t frame) {
    const auto found = days_.find(frame);
    if (found != days_.end()) return found->second;
    return days_.emplace(frame, RecordedDay(*frames_.frame(frame))).first->second;
  }

 private:
  const FrameSequence& frames_;
  std::map<std::size_t, RecordedDay> days_;
};

/// A measurement's value in a sequence. A rise or a shift is that of a pole since the first frame
/// that has it.
std::optional<double> value_of(const EmbryoScene& scene, Days& days, const Measurement& measurement,
                               std::size_t frame) {
  const std::string& quantity = measurement.quantity;
  const bool rises = quantity == "upper_pole_rise", shifts = quantity == "lower_pole_shift";
  if (!rises && !shifts) return reading(scene, days[frame], quantity, measurement.structure);
  const std::string height = rises ? "upper_pole_height" : "lower_pole_height";
  const auto last = reading(scene, days[frame], height, measurement.structure);
  if (!last) return std::nullopt;
  for (std::size_t i = 0; i <= frame; ++i)
    if (const auto first = reading(scene, days[i], height, measurement.structure))
      return *last - *first;
  return std::nullopt;
}

std::optional<std::size_t> frame_at(const FrameSequence& frames, double day) {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (std::abs(frames.parameter(i) - day) < 1e-9) return i;
  return std::nullopt;
}

}  // namespace

std::optional<ScoreMeasures> score_measures(const EmbryoScene& scene, const FrameSequence& frames) {
  if (scene.ontology.measurements.empty() || frames.size() == 0) return std::nullopt;
  if (frames.frame(0)->find_table(recorded::kBody) == nullptr) return std::nullopt;  // no bodies
  Days days(frames);
  ScoreMeasures m;
  double squares = 0, worst = 0;
  for (const Measurement& one : scene.ontology.measurements) {
    const auto frame = frame_at(frames, scene.ontology.stages[one.stage].middle());
    if (!frame) continue;
    if (std::find(one.input_of.begin(), one.input_of.end(), scene.options.parameter_set) !=
        one.input_of.end()) {
      ++m.inputs;
      continue;
    }
    const auto value = value_of(scene, days, one, *frame);
    if (!value) continue;
    ++m.scored;
    if (*value >= one.low && *value <= one.high) ++m.inside;
    const double off = one.deviation > 0 ? std::abs(*value - one.mean) / one.deviation : 0;
    squares += off * off;
    worst = std::max(worst, off);
  }
  if (m.scored + m.inputs == 0) return std::nullopt;
  if (m.scored > 0) {
    m.rms = std::sqrt(squares / m.scored);
    m.worst = worst;
  }
  return m;
}

}  // namespace geoprior::embryo
