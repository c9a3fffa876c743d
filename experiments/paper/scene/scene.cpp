#include "experiments/paper/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <system_error>

#include "core/error.h"
#include "experiments/paper/scene/fast_handles.h"
#include "experiments/paper/scene/pulled_apart.h"
#include "experiments/paper/scene/sheet_files.h"
#include "experiments/paper/scene/swatches.h"
#include "experiments/sound/scene/bank_files.h"
#include "models/paper/sheet/valid.h"
#include "testbed/home.h"
#include "testbed/keyframes.h"

namespace geoprior::paper {
namespace {

namespace fs = std::filesystem;

void require_count(const std::vector<double>& numbers, std::size_t count,
                   const std::string& where) {
  if (numbers.size() == count) return;
  throw Error("has " + std::to_string(numbers.size()) + " numbers", where, std::to_string(count));
}

Handle make_handle(const HandleOptions& options, const std::string& where) {
  Handle handle;
  handle.name = options.name;
  for (const PatternPointOptions& p : options.points) handle.points.emplace_back(p.u, p.v);
  if (!options.segment.empty()) {
    const std::vector<double>& s = options.segment;
    require_count(s, 4, where + ".segment");
    handle.segment = {Eigen::Vector2d(s[0], s[1]), Eigen::Vector2d(s[2], s[3])};
  }
  if (options.disc) {
    if (!options.points.empty()) {
      throw Error("has more than one shape", where, "points, segment or disc");
    }
    handle.points = {Eigen::Vector2d(options.disc->u, options.disc->v)};
    handle.disc_radius = options.disc->radius;
  }
  if (!options.keys.empty()) handle.motion = to_trajectory(options.keys, where + ".keys");
  handle.stiffness = options.stiffness;
  if (!options.force.empty()) {
    require_count(options.force, 3, where + ".force");
    handle.force = Eigen::Vector3d(options.force[0], options.force[1], options.force[2]);
  }
  for (const IntervalOptions& interval : options.active) {
    handle.active.emplace_back(interval.from, interval.to);
  }
  return handle;
}

Toughness to_toughness(const ToughnessOptions& options, std::uint64_t seed) {
  return {options.energy.value_or(0),     options.noise,     options.noise_length,
          scene_seed(seed, options.seed), options.grain_deg, options.across};
}

Obstacle make_obstacle(const ObstacleOptions& options, const std::string& where) {
  Obstacle obstacle;
  obstacle.kind = options.kind;
  obstacle.name = options.name;
  obstacle.centre = to_vector(options.centre);
  const Eigen::Vector3d axis = to_vector(options.axis);
  if (!(axis.norm() > 0))
    throw Error("has no direction", where + ".axis", "a vector of any length");
  obstacle.axis = axis.normalized();
  obstacle.radius = options.radius;
  obstacle.tube_radius = options.tube_radius;
  obstacle.half_length = options.half_length;
  if (!options.keys.empty()) obstacle.motion = to_trajectory(options.keys, where + ".keys");
  for (const RadiusKeyOptions& key : options.radii) {
    obstacle.radii.emplace_back(key.t, key.radius);
  }
  return obstacle;
}

std::vector<Eigen::Vector2d> loop_of(const std::vector<PatternPointOptions>& points) {
  std::vector<Eigen::Vector2d> loop;
  for (const PatternPointOptions& p : points) loop.emplace_back(p.u, p.v);
  return loop;
}

/// With the holes of the file. Corners are in its order, either way round: errors number them so.
Pattern with_holes(Pattern pattern, const std::vector<HoleOptions>& holes) {
  for (const HoleOptions& hole : holes) pattern.holes.push_back(loop_of(hole.points));
  require_simple_loops(pattern, "scene.pattern");
  return oriented(std::move(pattern));
}

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

Pattern make_pattern(const PatternOptions& options, const fs::path& folder,
                     std::vector<fs::path>& files) {
  switch (options.kind) {
    case PatternKind::rectangle:
      return with_holes(rectangle_pattern(options.width, options.height), options.holes);
    case PatternKind::disc:
      return with_holes(disc_pattern(options.radius, options.corners), options.holes);
    case PatternKind::polygon:
      return with_holes({loop_of(options.points)}, options.holes);
    case PatternKind::svg: {
      files.push_back(find_file(options.file, folder, "experiments/paper", "scene.pattern.file"));
      return read_svg_pattern(files.back(), options.svg);
    }
  }
  throw Error("unknown kind of pattern", "scene.pattern", "rectangle, disc, polygon, svg");
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

const std::shared_ptr<const SheetAnimation>& PaperScene::require_animation(
    const std::string& who) const {
  if (!animation) {
    throw Error(who + " has nothing to listen to", "scene.animation",
                "a table with the path of an animated sheet");
  }
  return animation;
}

Sheet make_sheet(const PaperSceneOptions& options, const Pattern& pattern, std::uint64_t seed) {
  Sheet sheet;
  sheet.pattern = pattern;
  sheet.material = options.material;
  sheet.toughness = to_toughness(options.toughness, seed);
  for (std::size_t i = 0; i < options.handles.size(); ++i) {
    sheet.handles.push_back(make_handle(options.handles[i], "scene.handles." + std::to_string(i)));
  }
  for (std::size_t i = 0; i < options.obstacles.size(); ++i) {
    sheet.obstacles.push_back(
        make_obstacle(options.obstacles[i], "scene.obstacles." + std::to_string(i)));
  }
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
                                             const fs::path& folder, std::uint64_t seed) {
  auto scene = std::make_shared<PaperScene>();
  Pattern pattern = make_pattern(options.pattern, folder, scene->input_files);
  for (const CutOptions& cut : options.pattern.cuts) pattern.cuts.push_back(loop_of(cut.points));
  scene->sheet = make_sheet(options, pattern, seed);
  scene->fold_radius = options.fold_radius;
  require_valid(scene->sheet, "scene");
  if (options.animation && options.swatches) {
    throw Error("is given beside an animation", "scene.swatches", "one of both");
  }
  if (options.swatches) scene->animation = make_swatches(*options.swatches, scene->sheet);
  if (options.animation) {
    scene->animation = open_sheet_files(*options.animation, folder, scene->sheet.pattern,
                                        scene->load_warnings, scene->input_files);
  }
  if (scene->animation) {
    if (options.bank) {
      const fs::path bank = find_file(*options.bank, folder, "data", "scene.bank");
      scene->bank =
          std::make_shared<SoundBank>(read_bank(bank, scene->load_warnings, scene->input_files));
    }
    return scene;
  }
  if (options.bank) throw Error("is given without an animation", "scene.bank", "scene.animation");
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
