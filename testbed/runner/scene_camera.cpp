#include "testbed/runner/scene_camera.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "testbed/runner/options/json.h"
#include "testbed/runner/options/toml.h"

namespace geoprior {
namespace {

/// What the first case that the view draws suggests; null when it suggests nothing.
const std::string* suggested_camera(const FigureView& view, const RunRecord& record) {
  for (const CaseRecord& one : record.cases) {
    const auto& wanted = view.cases;
    const bool is_drawn = wanted.empty()
                              ? !one.claims_only
                              : std::find(wanted.begin(), wanted.end(), one.name) != wanted.end();
    if (is_drawn) return one.camera.empty() ? nullptr : &one.camera;
  }
  return nullptr;
}

}  // namespace

void describe(OptionVisitor& v, Camera& camera) {
  v.value("target", camera.target, {.doc = "centre of the view", .unit = "m"});
  v.value("direction", camera.direction, {.doc = "direction from the target to the eye"});
  v.value("up", camera.up, {.doc = "upwards in the picture"});
  v.value("height_m", camera.height_m,
          {.doc = "height of the view", .unit = "m", .min = 1e-12, .max = 1e12});
}

std::string camera_text(const Camera& camera) {
  return toml_text({{"target", camera.target},
                    {"direction", camera.direction},
                    {"up", camera.up},
                    {"height_m", camera.height_m}});
}

FigureView with_scene_camera(FigureView view, const RunRecord& record, const std::string& file) {
  const std::string* text = view.camera_is_free ? suggested_camera(view, record) : nullptr;
  if (text == nullptr) return view;
  Camera camera;
  read_options(parse_toml_text(*text, file + ", camera of the scene"), "", camera);
  view.target = camera.target;
  view.direction = camera.direction;
  view.up = camera.up;
  view.height_m = camera.height_m;
  return view;
}

}  // namespace geoprior
