#include "experiments/embryo/query_command.h"

#include <array>
#include <filesystem>

#include "core/error.h"
#include "experiments/embryo/scene/scene.h"
#include "solvers/embryo/triples/read.h"
#include "testbed/commands/find.h"
#include "testbed/formats/text/text_file.h"
#include "testbed/home.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior::embryo {
namespace {

constexpr std::uintmax_t kMostQueryBytes = 1u << 20;
constexpr const char* kHealthy = "none";

EmbryoSceneOptions scene_options_of(const std::filesystem::path& file) {
  const TomlNode root = parse_toml_file(file);
  const TomlNode* table = root.find("scene");
  if (table == nullptr) throw Error("has no [scene]", file.string(), "an experiment of the embryo");
  if (const TomlNode* topic = root.find("topic");
      topic != nullptr && topic->kind == TomlNode::Kind::text && topic->text != "embryo")
    throw Error("is of the topic '" + topic->text + "'", file.string(), "embryo");
  EmbryoSceneOptions options;
  read_options(*table, "scene", options);
  options.expected = options.queries = std::nullopt;  // what a run is compared with, and asked
  return options;
}

SparqlQuery read_query(const std::string& name) {
  const std::filesystem::path file = find_file(name, std::filesystem::current_path(),
                                               "experiments/embryo/queries", "option query");
  if (std::filesystem::file_size(file) > kMostQueryBytes)
    throw Error("is too large", file.string(), std::to_string(kMostQueryBytes) + " bytes");
  return {read_text_file(file), file.string()};
}

CommandText run_query(const std::string& input, const QueryOptions& options) {
  const std::filesystem::path file = experiment_file(input);
  EmbryoSceneOptions scene_options = scene_options_of(file);
  if (options.disease) scene_options.disease = options.disease;
  if (options.disease == kHealthy) scene_options.disease = std::nullopt;
  const SparqlQuery query = read_query(options.query);
  const auto scene = load_embryo_scene(scene_options, file.parent_path());
  CommandText out;
  out.text = run_sparql(to_ntriples(scene->saturated), std::array{query},
                        {options.format, options.timeout_s, options.memory_mb})
                 .front();
  return out;
}

}  // namespace

void describe(OptionVisitor& v, QueryOptions& options) {
  static constexpr std::array<std::string_view, 2> kFormats{"csv", "json"};
  v.value("query", options.query,
          {.doc = "file with a SPARQL 1.1 query (SELECT, ASK or CONSTRUCT), also by its name in "
                  "experiments/embryo/queries",
           .required = true});
  describe_choice(v, "format", options.format, kFormats,
                  {.doc = "form of the answer: CSV with a line of names, or SPARQL results JSON"});
  v.value("timeout_s", options.timeout_s,
          {.doc = "longest time that reading the graph or the query may take",
           .unit = "s",
           .min = 0.1,
           .max = 86400});
  v.value("memory_mb", options.memory_mb,
          {.doc = "address space that the query engine may use",
           .unit = "MB",
           .min = 64,
           .max = 1'000'000});
  v.value("disease", options.disease,
          {.doc = "disease of the ontology instead of the scene's; 'none': healthy"});
}

TopicCommand query_command() {
  TopicCommand command = topic_command<QueryOptions>(
      "query",
      "the answer of a SPARQL query over an experiment's ontology and what follows from it",
      "experiment", "experiment of the topic embryo: identifier or .toml file", run_query);
  command.second_argument = "query";
  return command;
}

}  // namespace geoprior::embryo
