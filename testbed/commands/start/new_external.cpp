#include "testbed/commands/start/new_external.h"

#include <toml++/toml.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "testbed/commands/console.h"
#include "testbed/commands/find.h"
#include "testbed/commands/message_line.h"
#include "testbed/commands/start/starters.h"
#include "testbed/external/method.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/folders.h"
#include "testbed/joined.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/shell_word.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgramName = "my_method.py";

std::string readme(const Starter& starter) {
  const bool is_sound = starter.changes == StarterChanges::sound;
  const std::string run = starter.topic + "/experiment";
  return "# A method of your own beside those of `" + starter.topic +
         "`\n\n"
         "    geoprior run experiment.toml --allow-commands\n\n"
         "starts `my_method.py` for each case, measures what it leaves as it measures all, and "
         "draws it beside `" +
         starter.beside + "`\n(" + (is_sound ? "`spectrogram.png`" : "`figure.png`") +
         "). Edit the function `" + starter_function(starter) +
         "` of the program: as it stands it returns what the variant\nbeside makes, so that every "
         "number is equal; with the instance that it names they are not.\n\n"
         "    geoprior compare " +
         run + " " + run + " --variants " + starter.beside +
         "=mine\n\n"
         "says which numbers of the newest run are better or worse than those of the variant "
         "beside.\n\n"
         "The program needs NumPy in the `python3` that is first in PATH (`geoprior doctor` "
         "looks). `--allow-commands`\nis there because an experiment file can start any program: "
         "read files of others before you give it.\n`docs/external-methods.md` says what is in "
         "`scene.json`, how frames are written, and what happens to a\nprogram that fails.\n";
}

/// Names of files beside the experiment that they come from become those of the files.
void name_files(toml::node& node, const fs::path& folder) {
  if (toml::table* table = node.as_table()) {
    for (auto&& [key, value] : *table) name_files(value, folder);
  } else if (toml::array* array = node.as_array()) {
    for (toml::node& value : *array) name_files(value, folder);
  } else if (toml::value<std::string>* text = node.as_string()) {
    std::error_code ignored;
    const fs::path file = folder / text->get();
    if (!text->get().empty() && fs::is_regular_file(file, ignored)) {
      *text = fs::absolute(file).lexically_normal().string();
    }
  }
}

toml::table variant_beside(const toml::table& all, const std::string& name) {
  for (const toml::node& node : *all["variant"].as_array()) {
    toml::table variant = *node.as_table();
    if (variant["name"].value_or(std::string()) != name) continue;
    variant.insert_or_assign("role", "baseline");
    variant.erase("reference");
    variant.erase("quick");
    return variant;
  }
  throw Error("has no variant '" + name + "'", "new external");
}

/// The small version of the starter's experiment, with one of its variants and the external one.
toml::table experiment_of(const Starter& starter, const std::vector<Topic>& topics) {
  LoadRequest load;
  load.quick = true;
  load.sets = starter.sets;
  const Experiment from = load_experiment(experiment_file(starter.experiment), topics, load);
  toml::table all = toml::parse(from.resolved_toml);
  name_files(*all.get("scene"), from.file.parent_path());
  toml::table mine;
  mine.insert("name", "mine");
  mine.insert("method", kExternalMethod);
  mine.insert("reference", starter.beside);
  mine.insert("options", toml::table{{"command", toml::array{"python3", kProgramName}}});
  toml::table experiment;
  experiment.insert("title", "A method of my own beside " + starter.beside);
  experiment.insert("topic", from.topic);
  experiment.insert("seed", 1);
  experiment.insert("scene", *all["scene"].as_table());
  experiment.insert("variant", toml::array{variant_beside(all, starter.beside), mine});
  experiment.insert("figure_view", toml::parse(starter.view));
  return experiment;
}

const Starter& starter_of(const std::string& topic) {
  for (const Starter& starter : starters()) {
    if (starter.topic == topic) return starter;
  }
  throw Error("unknown topic '" + topic + "'", "new external", joined(topics_of_starters()));
}

void require_new_folder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) return;
  if (!fs::is_directory(folder, ignored) || !fs::is_empty(folder, ignored)) {
    throw Error("is there already", folder.string(), "a new or empty folder (--out)");
  }
}

}  // namespace

int new_command(const CommandContext& context, const NewRequest& request) {
  const Starter& starter = starter_of(request.topic);
  const fs::path folder = request.out.empty() ? "my-" + request.topic + "-method" : request.out;
  require_new_folder(folder);
  std::ostringstream experiment;
  experiment << "# " << starter.experiment << ", made small, and a method from outside.\n\n"
             << experiment_of(starter, context.topics) << "\n";
  const MadeFolders made(folder);
  write_file_atomically(folder / kProgramName, std::string_view(starter_program(starter)));
  write_file_atomically(folder / "experiment.toml", std::string_view(experiment.str()));
  write_file_atomically(folder / "README.md", std::string_view(readme(starter)));
  const std::string file = (folder / "experiment.toml").string();
  say("program     " + message_line((folder / kProgramName).string()) + " (edit `" +
      starter_function(starter) + "`)");
  say("experiment  " + message_line(file));
  say("next        " + shell_line({"geoprior", "run", file, "--allow-commands"}));
  if (context.json) print_json({{"folder", folder.string()}, {"beside", starter.beside}});
  return done;
}

}  // namespace geoprior
