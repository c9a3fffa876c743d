#include "experiments/grammar/derive_command.h"

#include <filesystem>

#include "core/error.h"
#include "experiments/grammar/processes/methods.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::grammar {
namespace {

std::shared_ptr<GrammarScene> scene_of_experiment(const std::filesystem::path& file) {
  const TomlNode root = parse_toml_file(file);
  const TomlNode* table = root.find("scene");
  if (table == nullptr)
    throw Error("has no [scene]", file.string(), "an experiment of the grammar");
  if (const TomlNode* topic = root.find("topic");
      topic != nullptr && topic->kind == TomlNode::Kind::text && topic->text != "grammar")
    throw Error("is of the topic '" + topic->text + "'", file.string(), "grammar");
  const TomlNode* seed = root.find("seed");
  GrammarSceneOptions options;
  read_options(*table, "scene", options);
  const bool given = seed != nullptr && seed->kind == TomlNode::Kind::integer;
  return load_grammar_scene(options, file.parent_path(),
                            given ? static_cast<std::uint64_t>(seed->integer) : 1);
}

std::string element_list(const Hierarchy& h, const std::vector<int>& elements) {
  constexpr std::size_t kMostShown = 12;
  std::string out;
  for (std::size_t i = 0; i < elements.size() && i < kMostShown; ++i)
    out += (i > 0 ? ", " : " ") + h.label(elements[i]);
  if (elements.size() > kMostShown)
    out += " and " + std::to_string(elements.size() - kMostShown) + " more";
  return out;
}

CommandText derive_step(const std::string& input, const DeriveOptions& options) {
  const auto scene = scene_of_experiment(input);
  const int last = static_cast<int>(scene->steps.size()) - 1;
  const int step = options.step.value_or(last);
  if (last == 0) throw Error("has no edit and no gesture", input, "scene.edits, scene.gesture");
  if (step < 1 || step > last)
    throw Error("there is no step " + std::to_string(step), "--step",
                "1 to " + std::to_string(last));
  const auto rules =
      options.script ? GrammarMethodOptions::Rules::both : GrammarMethodOptions::Rules::native;
  RunContext context;
  DeformationGrammar grammar(scene->rest, scene_rules(*scene, rules, {}, context.seed()), {});
  for (int i = 1; i < step && scene->steps[i].kind == Step::Kind::edit; ++i)
    grammar.edit(scene->edits[scene->steps[i].number].wish,
                 scene->edits[scene->steps[i].number].tag);
  DerivationReport report;
  if (scene->steps[step].kind == Step::Kind::edit) {
    report = grammar.edit(scene->edits[scene->steps[step].number].wish, {}, true);
  } else {
    const auto map = scene->asked_map(step);
    report = grammar.gesture(scene->gesture_element, map, map, true);
  }
  CommandText out;
  out.text = trace_text(grammar.state(), report);
  const std::vector<int> changed = grammar.transaction().changed();
  out.notices = {std::to_string(report.rewrites) + " rewrites of " +
                     std::to_string(grammar.transaction().touched().size()) + " elements, from '" +
                     grammar.state().label(report.turned_at) + "' down",
                 std::to_string(changed.size()) + " elements would change" +
                     (changed.empty() ? "" : ":") + element_list(grammar.state(), changed),
                 std::to_string(report.spawned) + " would be new, " +
                     std::to_string(report.removed) + " taken away"};
  if (!options.out.empty()) {
    write_file_atomically(options.out, out.text);
    out.text = options.out + "\n";
  }
  return out;
}

}  // namespace

void describe(OptionVisitor& v, DeriveOptions& options) {
  v.value("step", options.step,
          {.doc = "number of the edit or step of the gesture; absent: the last", .min = 1});
  v.value("script", options.script,
          {.doc = "whether the rules of the scene's script come before those in C++"});
  v.value("out", options.out, {.doc = "file that the tree is written to; empty: standard output"});
}

TopicCommand derive_command() {
  return topic_command<DeriveOptions>(
      "derive", "a deformation grammar's derivation as a tree, without a run", "experiment",
      "experiment file of the topic grammar", derive_step);
}

}  // namespace geoprior::grammar
