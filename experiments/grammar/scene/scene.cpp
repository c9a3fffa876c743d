#include "experiments/grammar/scene/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "core/random.h"
#include "experiments/grammar/files/gesture_file.h"
#include "experiments/grammar/files/imported.h"
#include "experiments/grammar/scene/stretched.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/home.h"

namespace geoprior::grammar {
namespace {

namespace fs = std::filesystem;

/// That one edit may ask for.
constexpr double kMostNewChildren = 1000;

std::string object_name(Object object) {
  constexpr std::array<const char*, 8> kNames{"tree",      "building", "surface-set", "volume-set",
                                              "landscape", "forest",   "arm",         "imported"};
  return kNames[static_cast<std::size_t>(object)];
}

Delta asked_delta(const Hierarchy& h, int element, const EditOptions& e, const std::string& where) {
  switch (e.kind) {
    case EditOptions::Kind::translate:
      return Delta::translate(Eigen::Vector3d::Map(e.by.data()));
    case EditOptions::Kind::turn: {
      const Eigen::Vector3d axis = Eigen::Vector3d::Map(e.axis.data());
      if (axis.norm() == 0) throw Error("has no direction", where + ".axis");
      const Eigen::Vector3d x = h.position(element);
      return Delta::rigid(
          Eigen::Translation3d(x) *
          Eigen::AngleAxisd(e.angle_deg * std::numbers::pi / 180, axis.normalized()) *
          Eigen::Translation3d(-x));
    }
    case EditOptions::Kind::set:
      return Delta::set(h.type(element).parameter(e.parameter), e.value);
    case EditOptions::Kind::extrude:
      return Delta::extrude(h.type(element).parameter(e.parameter), e.value);
    case EditOptions::Kind::children:
      if (e.value == 0 || e.value != std::round(e.value) || std::abs(e.value) > kMostNewChildren)
        throw Error("is no number of children", where + ".value", "-1000 … -1, 1 … 1000");
      return Delta::children(static_cast<int>(e.value));
  }
  return {};
}

SceneEdit scene_edit(const Hierarchy& h, const EditOptions& e, int number) {
  const std::string where = "scene.edits[" + std::to_string(number) + "]";
  SceneEdit out;
  out.wish.element = h.find(e.element, where + ".element");
  try {
    out.wish.delta = asked_delta(h, out.wish.element, e, where);
  } catch (const Error& error) {
    throw Error(error.what(), where);
  }
  if (e.keep != EditOptions::Keep::no)
    out.tag = Tag{number + 1,
                  e.keep == EditOptions::Keep::rigid ? Tag::Follow::rigid : Tag::Follow::stop};
  return out;
}

void add_gesture_steps(const GestureOptions& options, std::vector<Step>& steps) {
  double before = 0;
  require_count(static_cast<double>(options.steps) * options.repeats, "steps of a gesture",
                kMostFrames, "scene.gesture.steps");
  for (int k = 0; k < options.repeats; ++k) {
    for (int i = 1; i <= options.steps; ++i) {
      double fraction = static_cast<double>(i) / options.steps;
      if (options.course == GestureOptions::Course::back) fraction = 1 - std::abs(2 * fraction - 1);
      steps.push_back({Step::Kind::gesture, 0, fraction, before});
      before = fraction;
    }
    if (options.course == GestureOptions::Course::once) before = 0;
  }
}

void scale_gesture(Gesture& gesture, double factor) {
  for (Stroke& stroke : gesture.strokes) {
    for (Eigen::Vector3d& x : stroke.path) x *= factor;
    stroke.radius *= factor;
  }
  if (gesture.lattice) {
    gesture.lattice->low *= factor;
    gesture.lattice->high *= factor;
    for (Eigen::Vector3d& x : gesture.lattice->shifts) x *= factor;
  }
  if (gesture.cage) {
    gesture.cage->rest.V *= factor;
    gesture.cage->moved *= factor;
  }
}

Eigen::AlignedBox3d box_of(const Hierarchy& h) {
  std::vector<Eigen::Vector3d> keys;
  for (int e = 0; e < h.size(); ++e)
    if (h.present(e)) h.keys(e, keys);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : keys) box.extend(x);
  return box;
}

void load_gesture(const GrammarSceneOptions& options, const fs::path& folder, GrammarScene& scene) {
  if (options.gesture && options.random)
    throw Error("stands beside scene.gesture", "scene.random", "one of the two");
  if (options.gesture) {
    const fs::path file =
        find_file(options.gesture->file, folder, "experiments/grammar", "scene.gesture.file");
    ReadGesture read = read_gesture_file(file);
    scene.gesture = std::move(read.gesture);
    scene.input_files.insert(scene.input_files.end(), read.files.begin(), read.files.end());
    scale_gesture(scene.gesture, options.gesture->scale);
    if (!options.gesture->element.empty())
      scene.gesture_element = scene.rest.find(options.gesture->element, "scene.gesture.element");
    add_gesture_steps(*options.gesture, scene.steps);
  } else if (options.random) {
    for (int i = 0; i < options.random->count; ++i)
      scene.steps.push_back({Step::Kind::random, options.random->first + i, 1, 0});
  }
}

/// The object that the options describe, without edits.
/// @param stretch  factors of its sizes along x, y, z
Hierarchy make_object(const GrammarSceneOptions& options, const Eigen::Vector3d& stretch,
                      std::uint64_t seed) {
  switch (options.object) {
    case Object::tree:
      return make_tree(stretched(options.tree, stretch), seed);
    case Object::building:
      return make_building(stretched(options.building, stretch), seed);
    case Object::surface_set:
      return make_surface_set(stretched(options.surface_set, stretch), seed);
    case Object::volume_set:
      return make_volume_set(stretched(options.volume_set, stretch), seed);
    case Object::landscape:
      return make_landscape(stretched(options.landscape, stretch), seed);
    case Object::forest:
      return make_forest(options.forest, seed);
    case Object::arm:
    case Object::imported:
      break;
  }
  return make_arm(options.arm);
}

}  // namespace

std::shared_ptr<const SpatialMap> GrammarScene::asked_map(std::size_t step) const {
  const Step& s = steps.at(step);
  switch (s.kind) {
    case Step::Kind::rest:
      return map_of(gesture, 0);
    case Step::Kind::edit:
      return nullptr;
    case Step::Kind::gesture:
      return map_of(gesture, s.fraction);
    case Step::Kind::random:
      break;
  }
  return map_of(random_gesture(random_seed, s.number, box), 1);
}

std::shared_ptr<const SpatialMap> GrammarScene::asked_since(std::size_t step) const {
  const Step& s = steps.at(step);
  if (s.kind != Step::Kind::gesture || s.before == 0) return asked_map(step);
  return std::make_shared<ComposedMap>(std::make_shared<InverseMap>(map_of(gesture, s.before)),
                                       map_of(gesture, s.fraction));
}

std::vector<Dab> GrammarScene::asked_dabs(std::size_t step) const {
  const Step& s = steps.at(step);
  if (s.kind == Step::Kind::gesture) return dabs_of(gesture, s.fraction);
  if (s.kind == Step::Kind::random) return dabs_of(random_gesture(random_seed, s.number, box), 1);
  return {};
}

DrawnGesture GrammarScene::drawn_gesture(std::size_t step) const {
  const Step& s = steps.at(step);
  if (s.kind == Step::Kind::gesture) return drawn(gesture);
  if (s.kind == Step::Kind::random) return drawn(random_gesture(random_seed, s.number, box));
  return {};
}

std::vector<int> GrammarScene::tagged(std::size_t step) const {
  std::vector<int> out;
  for (std::size_t i = 1; i < step && i <= edits.size(); ++i)
    if (edits[i - 1].tag) out.push_back(edits[i - 1].wish.element);
  return out;
}

std::map<std::string, double> GrammarScene::facts() const {
  std::map<std::string, double> out{{"elements", rest.present_count()},
                                    {"steps", static_cast<double>(steps.size()) - 1}};
  for (int e = 0; e < rest.size(); ++e)
    if (rest.present(e)) out[rest.type(e).name + "_elements"] += 1;
  return out;
}

std::shared_ptr<GrammarScene> load_grammar_scene(const GrammarSceneOptions& options,
                                                 const fs::path& folder, std::uint64_t seed) {
  auto scene = std::make_shared<GrammarScene>();
  scene->kind = options.object;
  scene->object = object_name(options.object);
  scene->record = options.record;
  scene->random_seed = scene_seed(seed, options.seed);
  if (options.object == Object::imported) {
    const fs::path file =
        find_file(options.imported.file, folder, "experiments/grammar", "scene.imported.file");
    ImportedScene read = import_gltf(file, options.imported.unit);
    scene->rest = std::move(read.hierarchy);
    scene->input_files = std::move(read.files);
    scene->load_warnings = std::move(read.warnings);
  } else {
    scene->rest = make_object(options, {1, 1, 1}, scene->random_seed);
    if (options.object != Object::forest && options.object != Object::arm)
      scene->generate = [options, drawn_seed = scene->random_seed](const Eigen::Vector3d& stretch) {
        return make_object(options, stretch, drawn_seed);
      };
  }
  scene->rest.require_valid();
  scene->box = box_of(scene->rest);
  scene->steps.push_back({});
  for (std::size_t i = 0; i < options.edits.size(); ++i) {
    scene->edits.push_back(scene_edit(scene->rest, options.edits[i], static_cast<int>(i)));
    scene->steps.push_back({Step::Kind::edit, static_cast<int>(i)});
  }
  load_gesture(options, folder, *scene);
  if (!options.rules.empty()) {
    const fs::path file = find_file(options.rules, folder, "experiments/grammar", "scene.rules");
    scene->script = read_text_file(file);
    scene->script_file = file.string();
    scene->input_files.push_back(file);
  }
  return scene;
}

}  // namespace geoprior::grammar
