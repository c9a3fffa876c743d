#include "experiments/paper/scene/make_sheet.h"

#include <string>
#include <utility>

#include "core/error.h"
#include "core/random.h"
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

/// Without cuts.
Pattern uncut_pattern(const PatternOptions& options, const fs::path& folder,
                      std::vector<fs::path>& files, std::vector<std::string>& notes) {
  switch (options.kind) {
    case PatternKind::rectangle:
      return with_holes(rectangle_pattern(options.width, options.height), options.holes);
    case PatternKind::disc:
      return with_holes(disc_pattern(options.radius, options.corners), options.holes);
    case PatternKind::polygon:
      return with_holes({loop_of(options.points)}, options.holes);
    case PatternKind::svg: {
      files.push_back(find_file(options.file, folder, "experiments/paper", "scene.pattern.file"));
      return read_svg_pattern(files.back(), options.svg, notes);
    }
  }
  throw Error("unknown kind of pattern", "scene.pattern", "rectangle, disc, polygon, svg");
}

/// @param where  the key of the obstacle, for messages
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

}  // namespace

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

Toughness make_toughness(const ToughnessOptions& options, std::uint64_t seed) {
  return {options.energy.value_or(0),     options.noise,     options.noise_length,
          scene_seed(seed, options.seed), options.grain_deg, options.across};
}

std::vector<Obstacle> make_obstacles(const std::vector<ObstacleOptions>& options) {
  std::vector<Obstacle> obstacles;
  for (std::size_t i = 0; i < options.size(); ++i)
    obstacles.push_back(make_obstacle(options[i], "scene.obstacles." + std::to_string(i)));
  return obstacles;
}

Pattern make_pattern(const PatternOptions& options, const fs::path& folder,
                     std::vector<fs::path>& files, std::vector<std::string>& notes) {
  Pattern pattern = uncut_pattern(options, folder, files, notes);
  for (const CutOptions& cut : options.cuts) pattern.cuts.push_back(loop_of(cut.points));
  return pattern;
}

}  // namespace geoprior::paper
