#include "experiments/assembly/scene/scene.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "experiments/assembly/scene/given.h"
#include "experiments/assembly/scene/inputs.h"
#include "models/assembly/exchange/embedding.h"
#include "models/assembly/graph/labels.h"
#include "testbed/home.h"

namespace geoprior::assembly {
namespace {

namespace fs = std::filesystem;

/// A file, or the layouts of a folder in order of their names.
void add_files(const std::string& name, const fs::path& folder, std::vector<fs::path>& files) {
  constexpr const char* kKey = "scene.inputs";
  if (!fs::path(name).has_extension()) {
    std::vector<fs::path> layouts;
    const fs::path found = find_folder(name, folder, "data", kKey);
    for (const auto& entry : fs::directory_iterator(found))
      if (entry.path().extension() == ".xtc") layouts.push_back(entry.path());
    if (layouts.empty()) throw Error("holds no layouts (.xtc)", found.string());
    std::sort(layouts.begin(), layouts.end());
    files.insert(files.end(), layouts.begin(), layouts.end());
    return;
  }
  files.push_back(find_file(name, folder, "data", kKey));
}

void require_label(const AssemblySet& set, const std::string& label, const std::string& key) {
  if (std::any_of(set.types.begin(), set.types.end(),
                  [&](const PartType& type) { return is_meant(label, type.label); }))
    return;
  std::string labels;
  for (const PartType& type : set.types) labels += (labels.empty() ? "" : ", ") + type.label;
  throw Error("there is no part '" + label + "'", key, labels);
}

void require_labels(const AssemblySceneOptions& options, const AssemblySet& set) {
  for (const std::string& label : options.rules.grounded)
    require_label(set, label, "scene.rules.grounded");
  for (const PartLimit& limit : options.rules.bill)
    require_label(set, limit.label, "scene.rules.bill");
  for (const auto& [count, key] : {std::pair(&options.rules.entries, "scene.rules.entries.labels"),
                                   std::pair(&options.rules.exits, "scene.rules.exits.labels")})
    if (*count)
      for (const std::string& label : (*count)->labels) require_label(set, label, key);
  for (const std::string& label : options.guide.keep) require_label(set, label, "scene.guide.keep");
  for (const std::string& label : options.guide.use) require_label(set, label, "scene.guide.use");
}

std::vector<Assembly> chosen_models(std::vector<Assembly> models,
                                    const AssemblySceneOptions& options) {
  for (const std::string& name : options.models)
    if (std::none_of(models.begin(), models.end(),
                     [&](const Assembly& model) { return model.name == name; })) {
      std::string names;
      for (const Assembly& model : models) names += (names.empty() ? "" : ", ") + model.name;
      throw Error("there is no model '" + name + "'", "scene.models", names);
    }
  std::erase_if(models, [&](const Assembly& model) {
    const int parts = static_cast<int>(model.parts.size());
    return parts < options.least_parts || parts > options.most_parts ||
           (!options.models.empty() && std::find(options.models.begin(), options.models.end(),
                                                 model.name) == options.models.end());
  });
  if (models.empty())
    throw Error("no model is left", "scene.inputs",
                "fewer restrictions by least_parts, most_parts");
  return models;
}

void warn_of_pieces(const AssemblySet& set, std::vector<std::string>& warnings) {
  for (const Assembly& model : set.models)
    if (const int count = components(model).count; count > 1)
      warnings.push_back("model '" + model.name + "' is of " + std::to_string(count) +
                         " pieces that nothing joins: replacements are made in each of them");
}

}  // namespace

std::map<std::string, double> AssemblyScene::facts() const {
  std::map<std::string, double> out{
      {"models", input.set.models.size()},
      {"part_types", input.set.types.size()},
      {"input_gap_mm", 1000 * input_misfit.translation},
      {"input_angle_deg", input_misfit.angle * 180 / std::numbers::pi}};
  double parts = 0, connections = 0;
  for (const Assembly& model : input.set.models) {
    parts += static_cast<double>(model.parts.size());
    connections += static_cast<double>(model.connections.size());
  }
  out["parts"] = parts;
  out["connections"] = connections;
  return out;
}

Frame AssemblyScene::given() const { return given_frame(input); }

std::shared_ptr<AssemblyScene> load_assembly_scene(const AssemblySceneOptions& options,
                                                   const fs::path& folder, std::uint64_t seed) {
  std::vector<fs::path> files;
  for (const std::string& name : options.inputs) add_files(name, folder, files);
  if (files.empty()) throw Error("names no file", "scene.inputs");
  ReadAssemblies read = read_assemblies(files);
  auto scene = std::make_shared<AssemblyScene>();
  scene->input_files = std::move(read.files);
  scene->load_warnings = std::move(read.warnings);
  scene->input.set = std::move(read.set);
  AssemblySet& set = scene->input.set;
  set.models = chosen_models(std::move(set.models), options);
  if (options.pieces) {
    if (options.pieces->least > options.pieces->most)
      throw Error("is more than scene.pieces.most", "scene.pieces.least");
    set.models = cut_pieces(set.models, *options.pieces, seed);
  } else {
    warn_of_pieces(set, scene->load_warnings);
  }
  require_labels(options, set);
  require_valid(options.guide, "scene.guide");
  for (Assembly& model : set.models) put_on_floor(model, set.types, options.rules);
  scene->input.rules = options.rules;
  scene->input.guide = options.guide;
  scene->input.survey = options.survey;
  for (const Assembly& model : set.models) {
    const Misfit worst = largest(joint_misfits(model, set.types));
    scene->input_misfit.translation = std::max(scene->input_misfit.translation, worst.translation);
    scene->input_misfit.angle = std::max(scene->input_misfit.angle, worst.angle);
  }
  return scene;
}

}  // namespace geoprior::assembly
