#include "experiments/embryo/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "solvers/embryo/ontology/read_ontology.h"
#include "solvers/embryo/rules/program.h"
#include "solvers/embryo/state/development.h"
#include "testbed/home.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::embryo {
namespace {

std::vector<std::string> names_of(const std::vector<Structure>& structures) {
  std::vector<std::string> names;
  for (const Structure& one : structures) names.push_back(one.name);
  return names;
}

std::optional<int> disease_of(const EmbryoSceneOptions& options, const Ontology& ontology) {
  if (!options.disease) return std::nullopt;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < ontology.diseases.size(); ++i) {
    if (ontology.diseases[i].name == *options.disease) return static_cast<int>(i);
    names.push_back(ontology.diseases[i].name);
  }
  throw Error("the ontology has no disease '" + *options.disease + "'", "scene.disease",
              allowed_names(*options.disease, names));
}

Facts closure_of(const EmbryoScene& scene, const RuleProgram& program,
                 const std::optional<std::string>& disease) {
  return saturate(program, base_facts(scene.graph, {disease, scene.options.parameter_set}));
}

void add_consequences(EmbryoScene& scene) {
  const RuleProgram program = parse_rules(scene.files.rules, scene.files.rules_where);
  const Facts facts = closure_of(scene, program, scene.options.disease);
  scene.effects = effects_of(facts, scene.graph, scene.ontology);
  scene.named_effects = effects_without_rules(scene.ontology, scene.disease);
  scene.saturated = saturated_graph(scene.graph, facts);
  scene.healthy_effects = scene.disease ? effects_of(closure_of(scene, program, std::nullopt),
                                                     scene.graph, scene.ontology)
                                        : scene.effects;
}

/// Solids have one, and what a division makes of them, which has no key of its own.
bool has_surface(const Ontology& ontology, const Structure& structure) {
  for (const Key& key : structure.keys)
    if (is_solid(key.geometry.primitive)) return true;
  for (const ProcessEntry& process : ontology.processes) {
    for (const int product : process.produces)
      if (process.kind == ProcessKind::division && &ontology.structures[product] == &structure)
        return true;
  }
  return false;
}

void name_structures(EmbryoScene& scene) {
  scene.structure_names = names_of(scene.ontology.structures);
  for (const Structure& one : scene.ontology.structures)
    scene.structure_labels.push_back(one.label);
  for (const Structure& one : scene.ontology.structures)
    if (has_surface(scene.ontology, one)) scene.kind_names.push_back(one.kind);
  std::sort(scene.kind_names.begin(), scene.kind_names.end());
  scene.kind_names.erase(std::unique(scene.kind_names.begin(), scene.kind_names.end()),
                         scene.kind_names.end());
  for (const Structure& one : scene.ontology.structures) {
    const auto at = std::lower_bound(scene.kind_names.begin(), scene.kind_names.end(), one.kind);
    scene.kind_of_structure.push_back(
        static_cast<int>(at - scene.kind_names.begin()));  // or the end
  }
}

void choose_meshed(EmbryoScene& scene) {
  scene.meshed.assign(scene.ontology.structures.size(), scene.options.only.empty());
  for (const std::string& name : scene.options.only) {
    const auto found = scene.ontology.find_structure(name);
    if (!found)
      throw Error("the ontology has no structure '" + name + "'", "scene.only",
                  allowed_names(name, scene.structure_names));
    scene.meshed[*found] = true;
  }
}

/// Two steps to either side of the middle of each stage that has both inside of the data.
void add_borders(std::vector<double>& days, const Ontology& ontology, double first, double last,
                 double step) {
  for (const Stage& stage : ontology.stages) {
    const double middle = stage.middle();
    if (middle - 2 * step < first || middle + 2 * step > last) continue;
    for (const int k : {-2, -1, 0, 1, 2}) days.push_back(middle + k * step);
  }
}

void choose_days(EmbryoScene& scene) {
  const Development development(scene.ontology, scene.healthy_effects, {});
  const double first = development.first_day(), last = development.last_day();
  const auto require_inside = [&](double day, const std::string& key) {
    if (day >= first && day <= last) return;
    throw Error("there are no data of day " + std::to_string(day), key,
                std::to_string(first) + " to " + std::to_string(last));
  };
  const EmbryoSceneOptions& options = scene.options;
  for (std::size_t i = 0; i < options.days.size(); ++i)
    require_inside(options.days[i], "scene.days." + std::to_string(i));
  scene.days = options.days;
  if (scene.days.empty()) {
    const double from = options.from_day.value_or(first), to = options.to_day.value_or(last);
    require_inside(from, "scene.from_day");
    require_inside(to, "scene.to_day");
    if (from > to) throw Error("begins after it ends", "scene.from_day", "days in their order");
    for (int i = 0; i < options.frames; ++i)
      scene.days.push_back(options.frames == 1 ? from
                                               : from + (to - from) * i / (options.frames - 1));
  }
  if (options.border_step)
    add_borders(scene.days, scene.ontology, scene.days.front(), scene.days.back(),
                *options.border_step);
  std::sort(scene.days.begin(), scene.days.end());
  scene.days.erase(std::unique(scene.days.begin(), scene.days.end()), scene.days.end());
}

}  // namespace

std::vector<bool> EmbryoScene::named_structures() const {
  std::vector<bool> named(ontology.structures.size(), false);
  if (!disease) return named;
  for (const int process : ontology.diseases[*disease].disables)
    for (const int structure : ontology.processes[process].produces) named[structure] = true;
  return named;
}

std::map<std::string, double> EmbryoScene::facts() const {
  return {{"triples", static_cast<double>(graph.triples().size())},
          {"saturated_triples", static_cast<double>(saturated.triples().size())},
          {"structures", static_cast<double>(ontology.structures.size())},
          {"processes", static_cast<double>(ontology.processes.size())}};
}

std::shared_ptr<EmbryoScene> load_embryo_scene(const EmbryoSceneOptions& options,
                                               const std::filesystem::path& folder) {
  auto scene = std::make_shared<EmbryoScene>();
  scene->options = options;
  scene->files = read_source_files(options, folder);
  const Graph own = read_graph_of(scene->files);
  scene->violations = violations(own);
  require_model(own, scene->violations,
                options.count_mistakes ? Mistakes::counted : Mistakes::refused);
  scene->ontology =
      make_ontology(own, {options.parameter_set, 0}, scene->files.triples.front().where);
  scene->graph = options.copies == 1 ? own : replicated(own, options.copies);
  scene->disease = disease_of(options, scene->ontology);
  add_consequences(*scene);
  name_structures(*scene);
  choose_meshed(*scene);
  choose_days(*scene);
  if (options.expected) {
    const auto file = find_file(*options.expected, folder, "experiments/embryo", "scene.expected");
    scene->expected =
        options.disease ? read_expected_changes(file, *options.disease) : ExpectedChanges();
    scene->files.paths.push_back(file);
  }
  return scene;
}

}  // namespace geoprior::embryo
