#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "experiments/torus/print/artifacts.h"
#include "experiments/torus/scene/options.h"
#include "models/torus/input.h"
#include "testbed/topic.h"

namespace geoprior::torus {

/// A sequence of corrugations: what the methods are given.
class TorusScene final : public ProcessScene {
 public:
  TorusInput input;
  std::optional<PrintedBody> print;

  [[nodiscard]] double last_parameter() const;

  [[nodiscard]] std::string parameter_name() const override;
  [[nodiscard]] std::string parameter_unit() const override { return "1"; }
  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// What frames ask for, on the torus of revolution: "surface" and "detail" once, unless frames
  /// are views; else the parts and tables of frames, followed by the number of theirs.
  [[nodiscard]] Frame given() const override;
  [[nodiscard]] std::vector<Artifact> files_of(Frame& frame) const override;
  [[nodiscard]] bool frames_share_work() const override { return false; }
};

/// @throws Error  naming the key
std::shared_ptr<TorusScene> load_torus_scene(const TorusSceneOptions& options, std::uint64_t seed);

}  // namespace geoprior::torus
