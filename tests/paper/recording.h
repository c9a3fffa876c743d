#pragma once

#include <utility>
#include <vector>

#include "core/method.h"

namespace geoprior::paper {

/// Keeps what a process hands over.
class Recording final : public FrameSink {
 public:
  void frame(Frame frame) override { frames.push_back(std::move(frame)); }
  void event(const Event& /*event*/) override {}
  void artifact(Artifact /*artifact*/) override {}
  void checkpoint(const State& state) override { checkpoints.push_back(state); }

  std::vector<Frame> frames;
  std::vector<State> checkpoints;
};

}  // namespace geoprior::paper
