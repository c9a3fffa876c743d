#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "experiments/sound/scene/options.h"
#include "models/sound/animation.h"
#include "models/sound/voices/bank.h"
#include "testbed/topic.h"

namespace geoprior::sound {

/// An animated sheet, what holds it and what it slides along: what every method of sound is given.
class SoundScene final : public ProcessScene {
 public:
  Sheet sheet;
  std::shared_ptr<const SheetAnimation> animation;
  std::map<std::string, std::shared_ptr<const SheetAnimation>> others;  ///< by their names
  std::shared_ptr<const SoundBank> bank;                                ///< or null: generated

  /// The scene's animation for an empty name, else that of the others.
  /// @throws Error  for a name that none of them has
  [[nodiscard]] std::shared_ptr<const SheetAnimation> named(const std::string& name) const;

  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// The scene's animation, frame by frame: "sheet_0000" … with triangles where the mesh is another
  /// one than in the frame before, without where it is that; table "tears", a row a place that a
  /// tip comes to. No sheets when all frames have more than `kMostGiven` vertices.
  [[nodiscard]] Frame given() const override;
  static constexpr Eigen::Index kMostGiven = 2'000'000;  ///< some 100 bytes of files each
};

/// Opens the animation and reads the bank.
/// @param folder  of the experiment file, against which relative files are tried first
/// @param seed    of the experiment, for what the scene draws
/// @throws Error  naming key or file, and place (see require_valid)
std::shared_ptr<SoundScene> load_sound_scene(const SoundSceneOptions& options,
                                             const std::filesystem::path& folder,
                                             std::uint64_t seed);

}  // namespace geoprior::sound
