#include "experiments/torus/scene/scene.h"

#include <set>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "models/torus/frames.h"
#include "solvers/torus/exact/numbers.h"
#include "testbed/given_tables.h"

namespace geoprior::torus {
namespace {

Sampling sampling_of(const TorusSceneOptions& options, std::uint64_t seed) {
  Sampling sampling;
  sampling.surface = options.surface;
  sampling.windows = options.windows;
  sampling.whole = options.whole;
  sampling.seed = scene_seed(seed, options.window_seed);
  if (options.detail)
    sampling.detail = SquareWindow{{options.detail->x, options.detail->y}, options.detail->width};
  if (options.view) {
    const ViewOptions& view = *options.view;
    sampling.view = SquareWindow{{view.x, view.y}, view.width};
    sampling.zooms = view.zooms;
    sampling.nearer = view.nearer;
  }
  return sampling;
}

}  // namespace

std::string TorusScene::parameter_name() const {
  return input.sampling.zooms ? "zoom" : "corrugations";
}

double TorusScene::last_parameter() const {
  return input.sampling.zooms ? *input.sampling.zooms - 1.
                              : static_cast<double>(input.corrugations.size());
}

std::map<std::string, double> TorusScene::facts() const {
  std::map<std::string, double> facts{{"corrugations", input.corrugations.size()}};
  if (!input.corrugations.empty()) facts["number"] = input.corrugations.back().number;
  for (std::size_t i = 0; i < input.corrugations.size(); ++i)
    facts["N_" + std::to_string(i + 1)] = input.corrugations[i].number;
  return facts;
}

Frame TorusScene::given() const {
  // "grid" is for a file alone; the others are at the places of "windows".
  const std::set<std::string> left_out{"grid", "windows_before", "windows_base"};
  Frame given;
  std::vector<Frame> frames = asked_frames(input);
  for (int number = 0; number < std::ssize(frames); ++number) {
    Frame& asked = frames[number];
    for (auto& [name, part] : asked.parts) {
      if (left_out.contains(name)) continue;
      const bool once = part.kind == Part::Kind::triangles && !input.sampling.zooms;
      if (once && number > 0) continue;
      given.parts[once ? name : numbered(name, number)] = std::move(part);
    }
    for (auto& [name, table] : asked.tables) {
      // Those of the last frame are all.
      given.tables[name == "corrugations" ? name : numbered(name, number)] = std::move(table);
    }
  }
  return given;
}

std::vector<Artifact> TorusScene::files_of(Frame& frame) const {
  if (frame.parameter != last_parameter()) return {};
  return artifacts_of(input, print, frame);
}

std::shared_ptr<TorusScene> load_torus_scene(const TorusSceneOptions& options, std::uint64_t seed) {
  auto scene = std::make_shared<TorusScene>();
  TorusInput& input = scene->input;
  input.radii = {options.r1, options.r2};
  input.sampling = sampling_of(options, seed);
  if (options.print) scene->print = PrintedBody{options.print->size, options.print->thickness};
  if (options.print && options.view && options.print->thickness == 0)
    throw Error("0 makes no body of a part of the torus", "scene.print.thickness", "above 0");
  for (std::size_t i = 0; i < options.corrugations.size(); ++i) {
    const CorrugationOptions& asked = options.corrugations[i];
    Corrugation c{asked.direction, asked.number.value_or(kChosenNumber), 1, asked.share || i == 0};
    c.share = asked.share ? *asked.share
              : i == 0    ? first_share(input.radii)
                          : input.corrugations.back().share;
    input.corrugations.push_back(c);
  }
  choose_numbers(input, options.margin);
  require_valid(input);
  return scene;
}

}  // namespace geoprior::torus
