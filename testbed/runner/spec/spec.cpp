#include "testbed/runner/spec/spec.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/names.h"
#include "testbed/runner/options/json.h"
#include "testbed/runner/options/toml.h"
#include "testbed/runner/process/build_info.h"
#include "testbed/runner/spec/claims.h"
#include "testbed/runner/spec/json.h"
#include "testbed/runner/spec/left_out.h"
#include "testbed/runner/spec/overrides.h"
#include "testbed/runner/spec/resolve.h"
#include "testbed/runner/spec/sweeps.h"
#include "testbed/runner/spec/tables.h"
#include "testbed/runner/spec/view_times.h"
#include "testbed/streams.h"

namespace geoprior {

using Json = nlohmann::ordered_json;

namespace {

const Topic& topic_named(const std::vector<Topic>& topics, const std::string& name,
                         const TomlNode& root) {
  std::vector<std::string> names;
  for (const Topic& topic : topics) {
    if (topic.name == name) return topic;
    names.push_back(topic.name);
  }
  const TomlNode* node = root.find("topic");
  throw Error("unknown topic '" + name + "'",
              (node != nullptr ? node->place : root.place) + ": topic", allowed_names(name, names));
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// experiments/<folder>/<stem>.toml is <folder>/<stem>; any other file is <topic>/<stem>.
std::string id_of(const std::filesystem::path& file, const std::string& topic) {
  const std::filesystem::path whole = std::filesystem::absolute(file).lexically_normal();
  const std::filesystem::path folder = whole.parent_path();
  const bool placed = folder.parent_path().filename() == "experiments";
  return name_from(placed ? folder.filename().string() : topic) + "/" +
         name_from(whole.stem().string());
}

std::string read_id(const TomlNode& root, const HeaderTable& header,
                    const std::filesystem::path& file) {
  if (!header.id) return id_of(file, header.topic);
  require_experiment_id(*header.id, place_of(root, "id"));
  return *header.id;
}

template <class Table>
Json table_json(Table table) {
  OptionJsonWriter writer;
  describe(writer, table);
  return writer.json();
}

/// Sweeps with the values they were expanded with; names belong to the values of full runs, and to
/// quick ones that stand in for them one for one.
Json sweep_tables(const TomlNode& root, bool quick) {
  Json list = Json::array();
  for (const TomlNode& node : tables_of(root, "sweep")) {
    TomlNode kept = node;
    if (const TomlNode* reduced = node.find("quick_values"); reduced != nullptr && quick) {
      if (reduced->items.empty()) continue;
      const TomlNode values = *reduced;
      const bool one_for_one = values.items.size() == node.find("values")->items.size();
      kept.set("values", values);
      if (!one_for_one) kept.erase("names");
    }
    kept.erase("quick_values");
    list.push_back(json_of(kept));
  }
  return list;
}

/// Takes texts out of the table's list of that name; false when that leaves none of them.
template <class Keep>
bool keep_in_list(Json& table, const char* name, Keep keep) {
  if (!table.contains(name)) return true;
  Json kept = Json::array();
  for (const Json& one : table[name]) {
    if (keep(one.get<std::string>())) kept.push_back(one);
  }
  table[name] = kept;
  return !kept.empty();
}

/// Takes what is not made out of a table of a claim or a study; false when nothing is left that it
/// could be about.
bool keep_what_is_made(Json& table, const Experiment& experiment, const KnownNames& names) {
  const auto is_case = [&](const std::string& name) {
    return std::any_of(experiment.cases.begin(), experiment.cases.end(),
                       [&](const CaseSpec& one) { return name == one.name; });
  };
  const auto left_out = [&](const char* member) {
    return table.contains(member) && has(names.dropped, table[member].get<std::string>());
  };
  Json excepted = Json::array();
  for (Json one : table.value("except", Json::array())) {
    if (keep_in_list(one, "cases", is_case)) excepted.push_back(one);
  }
  table["except"] = excepted;
  if (excepted.empty()) table.erase("except");
  if (left_out("null")) table.erase("null");
  const std::string metric = table.value("metric", "");
  const bool no_study = metric.starts_with("study:") && !has(names.studies, metric.substr(6));
  const bool runs =
      keep_in_list(table, "variants", [&](const auto& name) { return !has(names.dropped, name); });
  return keep_in_list(table, "cases", is_case) && runs && !no_study && !left_out("variant") &&
         !left_out("of");
}

Json resolved_json(const TomlNode& root, const Experiment& experiment, const HeaderTable& header,
                   const CaseSpec& base, const KnownNames& names) {
  Json json = table_json(header);
  json["id"] = experiment.id;
  if (experiment.input) json["input"] = *experiment.input;
  json["size"] = experiment.quick ? "quick" : "full";
  json["scene"] = Json::parse(base.scene_json);
  json["timing"] = {{"repetitions", experiment.timing_repetitions}};
  if (experiment.timing_warm_up) json["timing"]["warm_up"] = *experiment.timing_warm_up;
  for (const auto& [metric, tolerance] : experiment.tolerances) {
    json["tolerance"][metric] = {{"absolute", tolerance.absolute},
                                 {"relative", tolerance.relative}};
  }
  json["variant"] = Json::array();
  for (const VariantSpec& variant : base.variants) {
    Json v{{"name", variant.name}, {"method", variant.method}, {"role", variant.role}};
    if (variant.reference) v["reference"] = *variant.reference;
    v["options"] = Json::parse(variant.options_json);
    json["variant"].push_back(v);
  }
  json["sweep"] = sweep_tables(root, experiment.quick);
  for (const char* key : {"claim", "study"}) {
    Json kept = Json::array();
    for (const TomlNode& node : tables_of(root, key)) {
      Json table = json_of(node);
      if (keep_what_is_made(table, experiment, names)) kept.push_back(table);
    }
    json[key] = kept;
  }
  for (const char* key : {"sweep", "claim", "study"}) {
    if (json[key].empty()) json.erase(key);
  }
  return json;
}

std::string spec_hash(const std::string& text) {
  const BuildInfo& build = build_info();
  return sha256(text + "\nversion " + build.version + "\ncommit " + build.git_commit +
                "\ndifference " + build.git_difference + "\n");
}

/// The variant that does nothing: the one that the file names, or the first of the topic's inputs
/// that it has.
std::optional<std::string> input_of(const TomlNode& root, const HeaderTable& header,
                                    const Topic& topic, const KnownNames& names) {
  if (header.input) {
    if (has(names.variants, *header.input)) return header.input;
    if (has(names.dropped, *header.input)) return std::nullopt;
    throw Error("there is no variant '" + *header.input + "'", place_of(root, "input"),
                allowed_names(*header.input, names.variants));
  }
  for (const std::string& method : topic.inputs) {
    for (const TomlNode& node : tables_of(root, "variant")) {
      const bool runs = has(names.variants, node.find("name")->text);
      if (runs && node.find("method")->text == method) return node.find("name")->text;
    }
  }
  return std::nullopt;
}

void read_timing(const TomlNode& root, Experiment& experiment) {
  TimingTable timing;
  if (const TomlNode* table = root.find("timing")) read_options(*table, "timing", timing);
  experiment.timing_repetitions = timing.repetitions;
  experiment.timing_warm_up = timing.warm_up;
}

void require_checked(const TomlNode& check, const std::string& key,
                     const std::vector<std::string>& metrics, const Topic& topic) {
  for (const std::string& metric : metrics) {
    const MetricEntry* row = find_metric(topic, metric);
    if (row == nullptr) {
      throw Error("unknown metric '" + metric + "'", place_of(check, key),
                  allowed_names(metric, metric_names(topic)));
    }
    if (!row->gated()) {
      throw Error("metric '" + metric + "' is not checked: " + row->ungated, place_of(check, key),
                  "rows that are not `ungated`");
    }
  }
}

/// What bifurcates is compared over its seeds: there must be some.
void read_check(const TomlNode& root, const Topic& topic, Experiment& experiment) {
  const TomlNode* node = root.find("check");
  if (node == nullptr) return;
  CheckTable table;
  read_options(*node, "check", table);
  experiment.bifurcates = table.bifurcates;
  experiment.checked_metrics = table.metrics;
  experiment.keeps_outcomes = table.outcomes;
  require_checked(*node, "metrics", table.metrics, topic);
  require_checked(*node, "quick_metrics", table.quick_metrics, topic);
  if (experiment.quick) {
    experiment.checked_metrics.insert(experiment.checked_metrics.end(), table.quick_metrics.begin(),
                                      table.quick_metrics.end());
  }
  const bool sweeps_seed =
      std::all_of(experiment.cases.begin(), experiment.cases.end(),
                  [](const CaseSpec& one) { return one.swept.contains("seed"); });
  if (experiment.bifurcates && !sweeps_seed) {
    throw Error("there are no seeds to take the median over", place_of(*node, "bifurcates"),
                "with a [[sweep]] over `seed`, base = false");
  }
}

}  // namespace

FigureView figure_view_of(const std::string& resolved_toml, const std::string& source,
                          const std::vector<Topic>& topics) {
  const TomlNode root = parse_toml_text(resolved_toml, source);
  const TomlNode* topic = root.find("topic");
  return read_figure_view(
      root, topic_named(topics, topic != nullptr ? topic->text : std::string(), root));
}

namespace {

Experiment load_parsed(const TomlNode& written, const std::filesystem::path& file,
                       const std::vector<Topic>& topics, const LoadRequest& request) {
  require_known_tables(written);
  TomlNode root = written;
  Experiment experiment;
  experiment.file = file;
  const std::vector<std::string> selected = select_variants(root, request.variants, request.quick);
  apply_quick(root, request.quick);
  apply_sets(root, request.sets);
  if (request.threads) {
    set_experiment_key(root, "threads",
                       parse_toml_value(std::to_string(*request.threads), "--threads"));
  }
  const HeaderTable header = read_header(root);
  experiment.id = read_id(root, header, file);
  require_line(header.title, "the title", place_of(root, "title"));
  experiment.title = header.title;
  experiment.figure = header.figure;
  experiment.topic = header.topic;
  experiment.quick = request.quick || header.size == RunSize::quick;
  const Topic& topic = topic_named(topics, header.topic, root);

  KnownNames names = known_names(root, written, selected, experiment.quick);
  if (request.variants.empty()) require_claimed_variants(root, names.dropped);
  drop_sweeps(root, names.dropped);
  TomlNode plain = root;
  plain.erase("sweep");
  for (const SweptCase& swept : expand_sweeps(root, experiment.quick)) {
    CaseSpec made = resolve_case(swept, plain, topic, selected);
    if (!made.variants.empty()) experiment.cases.push_back(std::move(made));
  }
  experiment.input = input_of(root, header, topic, names);
  read_timing(root, experiment);
  experiment.studies = read_studies(root, topic, names);
  drop_cases(experiment.studies, experiment.cases);
  for (const StudySpec& study : experiment.studies) names.studies.push_back(study.name);
  experiment.tolerances = read_tolerances(root, topic);
  experiment.claims = read_claims(root, topic, names, experiment.tolerances, experiment.studies);
  drop_cases(experiment.claims, experiment.cases);
  read_check(root, topic, experiment);
  leave_out_of_view(root, names, experiment.cases);
  (void)read_figure_view(root, topic);  // its own mistakes come before frames that are not there
  settle_view_times(written, root, topic, experiment.quick);
  experiment.view = read_figure_view(root, topic);

  Json resolved = resolved_json(root, experiment, header,
                                resolve_case(SweptCase{}, plain, topic, selected), names);
  experiment.hash = spec_hash(toml_text(resolved));
  for (const char* key : {"figure_view", "check"}) {
    if (const TomlNode* table = root.find(key)) resolved[key] = json_of(*table);
  }
  experiment.resolved_toml = toml_text(resolved);
  return experiment;
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file, const std::vector<Topic>& topics,
                           const LoadRequest& request) {
  return load_parsed(parse_toml_file(file), file, topics, request);
}

Experiment load_recorded_experiment(const std::string& resolved_toml, const std::string& source,
                                    const std::filesystem::path& file,
                                    const std::vector<Topic>& topics) {
  return load_parsed(parse_toml_text(resolved_toml, source), file, topics, {});
}

}  // namespace geoprior
