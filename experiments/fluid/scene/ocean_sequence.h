#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "baselines/fluid/ocean/ocean.h"
#include "core/inputs/surface_sequence.h"

namespace geoprior::fluid {

/// A procedural ocean as an animation: each frame is made when it is asked for.
class OceanSequence final : public SurfaceSequence {
 public:
  /// @param times  strictly increasing (s)
  OceanSequence(const OceanOptions& options, std::uint64_t seed, std::vector<double> times)
      : ocean_(options, seed), times_(std::move(times)) {}
  [[nodiscard]] int frame_count() const override { return static_cast<int>(times_.size()); }
  [[nodiscard]] double time(int frame) const override { return times_.at(frame); }
  [[nodiscard]] SurfaceFrame frame(int frame) const override {
    SurfaceFrame made;
    made.time = time(frame);
    made.mesh = ocean_.surface(made.time, &made.velocity);
    return made;
  }
  [[nodiscard]] std::string name() const override { return "ocean"; }

 private:
  Ocean ocean_;
  std::vector<double> times_;
};

}  // namespace geoprior::fluid
