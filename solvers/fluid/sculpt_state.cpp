#include "solvers/fluid/sculpt_state.h"

#include <cstring>

#include "core/error.h"

namespace geoprior::fluid {

State SculptState::bytes() const {
  std::string text;
  for (const std::string& w : warned) text += w + '\0';
  State state(sizeof next_frame + text.size());
  std::memcpy(state.data(), &next_frame, sizeof next_frame);
  if (!text.empty()) std::memcpy(state.data() + sizeof next_frame, text.data(), text.size());
  return state;
}

SculptState SculptState::of(const State& state) {
  SculptState result;
  if (state.size() < sizeof result.next_frame) {
    throw Error("is no state of this process", "checkpoint");
  }
  std::memcpy(&result.next_frame, state.data(), sizeof result.next_frame);
  std::string text;
  for (std::size_t i = sizeof result.next_frame; i < state.size(); ++i) {
    const auto c = static_cast<char>(state[i]);
    if (c != '\0') {
      text += c;
      continue;
    }
    result.warned.insert(text);
    text.clear();
  }
  if (!text.empty()) throw Error("is cut off", "checkpoint");
  return result;
}

void SculptState::warn(const std::string& text, const std::string& about, double time,
                       FrameSink& sink) {
  if (!warned.insert(about).second) return;
  Event event;
  event.time_s = time;
  event.kind = "warning: " + text;
  sink.event(event);
}

}  // namespace geoprior::fluid
