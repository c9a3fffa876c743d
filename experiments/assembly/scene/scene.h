#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "experiments/assembly/scene/options.h"
#include "models/assembly/search/input.h"
#include "testbed/topic.h"

namespace geoprior::assembly {

/// Models, the rules that assemblies keep, and what is asked of them.
class AssemblyScene final : public ProcessScene {
 public:
  AssemblyInput input;
  Misfit input_misfit;  ///< largest of the inputs' joints

  [[nodiscard]] std::string parameter_name() const override {
    return input.survey ? "model" : "variation";
  }
  [[nodiscard]] std::string parameter_unit() const override { return "1"; }
  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// As `given_frame` (given.h) says.
  [[nodiscard]] Frame given() const override;
  /// Variations of a generation are found together.
  [[nodiscard]] bool frames_share_work() const override { return input.survey.has_value(); }
};

/// @throws Error  naming key or file
std::shared_ptr<AssemblyScene> load_assembly_scene(const AssemblySceneOptions& options,
                                                   const std::filesystem::path& folder,
                                                   std::uint64_t seed);

}  // namespace geoprior::assembly
