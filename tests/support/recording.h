#pragma once

#include <utility>
#include <vector>

#include "core/method.h"

namespace geoprior::test {

/// Keeps what a process hands over.
class Recording final : public FrameSink {
 public:
  void frame(Frame frame) override { frames.push_back(std::move(frame)); }
  void event(const Event& event) override { events.push_back(event); }
  void artifact(Artifact artifact) override { artifacts.push_back(std::move(artifact)); }
  void checkpoint(const State& state) override { checkpoints.push_back(state); }

  std::vector<Frame> frames;
  std::vector<Event> events;
  std::vector<Artifact> artifacts;
  std::vector<State> checkpoints;
};

}  // namespace geoprior::test
