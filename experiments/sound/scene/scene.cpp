#include "experiments/sound/scene/scene.h"

#include "core/error.h"
#include "experiments/paper/scene/make_sheet.h"
#include "experiments/sound/scene/bank_files.h"
#include "models/paper/sheet/valid.h"
#include "testbed/home.h"

namespace geoprior::sound {
namespace {

namespace fs = std::filesystem;

/// A hand that stays where it is: that it holds is all that is heard of it.
Handle make_hold(const HoldOptions& options, const std::string& where) {
  Handle handle = paper::make_handle(options.handle, where);
  handle.motion = Trajectory{{Keyframe{}}};
  return handle;
}

Sheet make_sheet(const SoundSceneOptions& options, const Pattern& pattern, std::uint64_t seed) {
  Sheet sheet;
  sheet.pattern = pattern;
  sheet.material = options.material.paper;
  sheet.toughness = paper::make_toughness(options.toughness, seed);
  for (std::size_t i = 0; i < options.handles.size(); ++i) {
    sheet.handles.push_back(make_hold(options.handles[i], "scene.handles." + std::to_string(i)));
  }
  sheet.obstacles = paper::make_obstacles(options.obstacles);
  return sheet;
}

}  // namespace

std::map<std::string, double> SoundScene::facts() const {
  return {{"pattern_area", signed_area(sheet.pattern)},
          {"pattern_width", width(sheet.pattern)},
          {"handles", static_cast<double>(sheet.handles.size())},
          {"obstacles", static_cast<double>(sheet.obstacles.size())},
          {"frames", static_cast<double>(animation->frame_count())},
          {"bending_stiffness", sheet.material.bending_stiffness()}};
}

std::shared_ptr<const SheetAnimation> SoundScene::named(const std::string& name) const {
  if (name.empty()) return animation;
  const auto found = others.find(name);
  if (found != others.end()) return found->second;
  std::string allowed = "empty";
  for (const auto& other : others) allowed += ", " + other.first;
  throw Error("there is no '" + name + "' among scene.others", "options.animation", allowed);
}

std::shared_ptr<SoundScene> load_sound_scene(const SoundSceneOptions& options,
                                             const fs::path& folder, std::uint64_t seed) {
  if (options.animation && options.swatches) {
    throw Error("is given beside an animation", "scene.swatches", "one of both");
  }
  if (!options.animation && !options.swatches) {
    throw Error("has nothing to listen to", "scene",
                "animation, a table with the path of an animated sheet, or swatches");
  }
  auto scene = std::make_shared<SoundScene>();
  const Pattern pattern =
      paper::make_pattern(options.pattern, folder, scene->input_files, scene->load_warnings);
  scene->sheet = make_sheet(options, pattern, seed);
  paper::require_valid(scene->sheet, "scene");
  if (options.swatches) scene->animation = make_swatches(*options.swatches, scene->sheet);
  if (options.animation) {
    scene->animation = open_sheet_files(*options.animation, folder, scene->sheet.pattern,
                                        scene->load_warnings, scene->input_files);
  }
  for (std::size_t i = 0; i < options.others.size(); ++i) {
    const OtherAnimationOptions& other = options.others[i];
    SheetFileOptions files = options.animation.value_or(SheetFileOptions{});
    files.sequence.path = other.path;
    const bool is_new =
        scene->others
            .emplace(other.name, open_sheet_files(files, folder, scene->sheet.pattern,
                                                  scene->load_warnings, scene->input_files))
            .second;
    if (!is_new || other.name.empty()) {
      throw Error("is '" + other.name + "'", "scene.others." + std::to_string(i) + ".name",
                  "a name that no other has");
    }
  }
  if (options.bank) {
    const fs::path bank = find_folder(*options.bank, folder, "data", "scene.bank");
    scene->bank =
        std::make_shared<SoundBank>(read_bank(bank, scene->load_warnings, scene->input_files));
  }
  return scene;
}

}  // namespace geoprior::sound
