#include "experiments/paper/scene/scene.h"

#include <sstream>
#include <utility>

#include "experiments/paper/scene/drawn_surface.h"
#include "experiments/paper/scene/fast_handles.h"
#include "experiments/paper/scene/make_sheet.h"
#include "experiments/paper/scene/pulled_apart.h"
#include "models/paper/sheet/valid.h"
#include "testbed/keyframes.h"

namespace geoprior::paper {
namespace {

/// The waves of the start may dip into an obstacle that the flat sheet only touches.
void warn_of_waves(PaperScene& scene) {
  const Sheet& sheet = scene.sheet;
  if (sheet.imperfection <= 0) return;
  for (std::size_t i = 0; i < sheet.obstacles.size(); ++i) {
    const Obstacle& obstacle = sheet.obstacles[i];
    const auto near = start_nearer_than(sheet, obstacle, sheet.imperfection);
    if (!near) continue;
    std::ostringstream text;
    text << "scene.obstacles." << i << (obstacle.name.empty() ? "" : " '" + obstacle.name + "'")
         << " is nearer to the flat start of the sheet than its waves are high"
         << " (scene.imperfection = " << sheet.imperfection << " m), at the pattern point ("
         << near->x() << ", " << near->y() << ") m: they begin inside of it and are pushed out; "
         << "move one of them " << sheet.imperfection << " m away, or set imperfection = 0";
    scene.load_warnings.push_back(text.str());
  }
}

}  // namespace

std::map<std::string, double> PaperScene::facts() const {
  return {{"pattern_area", signed_area(sheet.pattern)},
          {"pattern_width", width(sheet.pattern)},
          {"pattern_corners", static_cast<double>(corners(sheet.pattern).size())},
          {"handles", static_cast<double>(sheet.handles.size())},
          {"obstacles", static_cast<double>(sheet.obstacles.size())},
          {"frames", static_cast<double>(sheet.frame_count())},
          {"membrane_stiffness", sheet.material.membrane_stiffness()},
          {"bending_stiffness", sheet.material.bending_stiffness()}};
}

std::vector<Artifact> PaperScene::files_of(Frame& frame) const {
  add_drawn_surface(frame);
  return {};
}

Sheet make_sheet(const PaperSceneOptions& options, const Pattern& pattern, std::uint64_t seed) {
  Sheet sheet;
  sheet.pattern = pattern;
  sheet.material = options.material;
  sheet.toughness = make_toughness(options.toughness, seed);
  for (std::size_t i = 0; i < options.handles.size(); ++i) {
    sheet.handles.push_back(make_handle(options.handles[i], "scene.handles." + std::to_string(i)));
  }
  sheet.obstacles = make_obstacles(options.obstacles);
  sheet.gravity = to_vector(options.gravity);
  sheet.placement = Eigen::Isometry3d::Identity();
  sheet.placement.translate(to_vector(options.placement.move))
      .rotate(to_rotation(options.placement.turn_deg));
  sheet.imperfection = options.imperfection;
  sheet.duration = options.duration;
  sheet.frame_interval = options.frame_interval;
  sheet.substeps = options.substeps;
  sheet.handle_step = options.handle_step;
  return sheet;
}

std::shared_ptr<PaperScene> load_paper_scene(const PaperSceneOptions& options,
                                             const std::filesystem::path& folder,
                                             std::uint64_t seed) {
  auto scene = std::make_shared<PaperScene>();
  const Pattern pattern =
      make_pattern(options.pattern, folder, scene->input_files, scene->load_warnings);
  scene->sheet = make_sheet(options, pattern, seed);
  scene->fold_radius = options.fold_radius;
  require_valid(scene->sheet, "scene");
  // Ten times what the imperfection may add.
  constexpr double kStretch = 1e-3;
  // What tears gives way.
  const bool holds = !scene->sheet.toughness.tears();
  if (const auto worst = holds ? worst_pulled_apart(scene->sheet, kStretch) : std::nullopt) {
    scene->load_warnings.push_back(warning_text(scene->sheet, *worst, "scene"));
  }
  if (auto text = fast_handle_warning(scene->sheet, "scene")) {
    scene->load_warnings.push_back(*std::move(text));
  }
  warn_of_waves(*scene);
  return scene;
}

}  // namespace geoprior::paper
