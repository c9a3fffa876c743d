#include "testbed/commands/start/starters.h"

#include <algorithm>
#include <utility>

namespace geoprior {

namespace {

/// Of topics whose frames are objects, steps or days.
std::vector<Starter> objects() {
  using enum StarterChanges;
  return {{.topic = "assembly",
           .experiment = "assembly/substructures",
           .beside = "exact",
           .view = R"(parameters = [2]
color_by = "exchanged"
classes = ["kept", "exchanged"])",
           .changes = pieces,
           .pieces = R"("parts", "part", slice(11, 14))",
           .instance = "1.1 * place"},
          {.topic = "details",
           .experiment = "details/options-motion",
           .beside = "self-replicating",
           .view = "parameters = [1]",
           .changes = points,
           .instance = "points * [1, 1.2, 1]"},
          {.topic = "embryo",
           .experiment = "embryo/urinary",
           .beside = "ontology",
           .view = "parameters = [54]",
           .changes = pieces,
           .pieces = R"("structures", "structure", slice(2, 5))",
           .instance = "1.1 * place"},
          {.topic = "grammar",
           .experiment = "grammar/propagation",
           .beside = "grammar",
           .view = R"(parameters = [2]
color_by = "type"
identities = true
overlays = ["gesture"])",
           .changes = points,
           .instance = "points * [1, 1, 1.2]"},
          {.topic = "sketch",
           .experiment = "sketch/hat",
           .beside = "drawn",
           .view = "direction = [0.7, 0.6, 1.0]",
           .changes = points,
           .instance = "points * [1, 1.2, 1]"},
          {.topic = "torus",
           .experiment = "torus/flat",
           .beside = "exact",
           .view = R"(parameters = [3]
direction = [0, -0.55, 0.85]
up = [0, 0, 1])",
           .changes = points,
           .instance = "points * [1, 1, 1.5]"}};
}

/// Of topics whose frames are times or poses.
std::vector<Starter> motions() {
  using enum StarterChanges;
  return {{.topic = "fluid",
           .experiment = "fluid/one-drop",
           .beside = "flip",
           .sets = {"scene.duration=0.3"},
           .view = R"(parameters = [0.3]
direction = [0.3, -1.0, 0.5]
up = [0, 0, 1])",
           .changes = points,
           .instance = "points * [1, 1, 1.5]"},
          {.topic = "paper",
           .experiment = "paper/bend",
           .beside = "dense",
           .view = R"(parameters = [0.4]
direction = [0.6, -1.0, 0.75]
up = [0, 0, 1])",
           .changes = points,
           .instance = "points * [1, 1, 1.5]"},
          {.topic = "skinning",
           .experiment = "skinning/cylinder-bend",
           .beside = "linear-blend",
           .view = R"(parameters = [90]
direction = [0.25, -1, 0.3]
up = [0, 0, 1])",
           .changes = points,
           .instance = "points * [1, 1, 1.2]"},
          {.topic = "sound",
           .experiment = "sound/options",
           .beside = "sound",
           .view = R"(parameters = [0.5]
part = "resonators")",
           .changes = sound,
           .instance = R"(np.apply_along_axis(np.convolve, 0, sound, np.ones(32) / 32, "same"))"}};
}

}  // namespace

const std::vector<Starter>& starters() {
  static const std::vector<Starter> all = [] {
    std::vector<Starter> both = objects();
    for (Starter& starter : motions()) both.push_back(std::move(starter));
    std::sort(both.begin(), both.end(),
              [](const Starter& a, const Starter& b) { return a.topic < b.topic; });
    return both;
  }();
  return all;
}

std::vector<std::string> topics_of_starters() {
  std::vector<std::string> topics;
  for (const Starter& starter : starters()) topics.push_back(starter.topic);
  return topics;
}

}  // namespace geoprior
