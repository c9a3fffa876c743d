#include "experiments/sound/scene/scene.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "experiments/paper/scene/make_sheet.h"
#include "experiments/sound/scene/bank_files.h"
#include "models/paper/sheet/valid.h"
#include "testbed/given_tables.h"
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

bool is_same(const ShellMesh& a, const ShellMesh& b) {
  return a.pattern.rows() == b.pattern.rows() && a.triangles.rows() == b.triangles.rows() &&
         a.pattern == b.pattern && a.triangles == b.triangles;
}

/// Of each vertex the first handle whose shape covers it; -1: none.
NamedArray handles_of(const Sheet& sheet, const Eigen::MatrixX2d& pattern) {
  NamedArray handle{"handle", "1", NamedArray::On::points,
                    Eigen::MatrixXd::Constant(pattern.rows(), 1, -1)};
  for (Eigen::Index v = 0; v < pattern.rows(); ++v) {
    const Eigen::Vector2d p = pattern.row(v);
    const auto first = std::find_if(sheet.handles.begin(), sheet.handles.end(),
                                    [&](const Handle& h) { return h.covers(p); });
    if (first != sheet.handles.end())
      handle.values(v, 0) = static_cast<double>(first - sheet.handles.begin());
  }
  return handle;
}

/// The sheet of a frame, with its mesh or with places alone.
Part given_sheet(const Sheet& sheet, const SheetSnapshot& now, bool with_mesh) {
  using On = NamedArray::On;
  Part part;
  part.points = now.x;
  if (now.v.rows() > 0) part.arrays.push_back({"velocity", "m/s", On::points, now.v});
  if (!with_mesh) {
    part.kind = Part::Kind::points;
    return part;
  }
  part.triangles = now.mesh.triangles;
  part.arrays.push_back({"pattern", "m", On::points, now.mesh.pattern});
  part.arrays.push_back(handles_of(sheet, now.mesh.pattern));
  return part;
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

Frame SoundScene::given() const {
  Frame given;
  std::vector<double> times;
  TableBuilder tears({"tear", "time [s]", "u [m]", "v [m]", "x [m]", "y [m]", "z [m]"});
  ShellMesh mesh;
  Eigen::Index vertices = 0;
  for (int i = 0; i < animation->frame_count(); ++i) {
    const SheetSnapshot now = animation->snapshot(i);
    for (const TornPlace& place : now.torn) {
      if (i > 0 && place.time <= times.back()) continue;
      const auto& [tear, time, at, x] = place;
      tears.add({static_cast<double>(tear), time, at.x(), at.y(), x.x(), x.y(), x.z()});
    }
    times.push_back(now.time);
    vertices += now.x.rows();
    if (vertices > kMostGiven) {
      given.parts.clear();
      continue;
    }
    const bool is_new = i == 0 || !is_same(mesh, now.mesh);
    given.parts[numbered("sheet", i)] = given_sheet(sheet, now, is_new);
    mesh = now.mesh;
  }
  given.tables["frames"] = frame_times(times);
  given.tables["tears"] = tears.finished();
  return given;
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
