#include <nlohmann/json.hpp>

#include "core/error.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/listing.h"
#include "testbed/runner/spec/tables.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

/// One thing that has a name and perhaps options.
struct Described {
  std::string kind;   ///< "method", "topic", "metric", "diagnostic", "file", "experiment"
  std::string title;  ///< "skinning/implicit"
  std::vector<std::pair<std::string, std::string>> facts;
  std::string options_place;  ///< "[scene]", "options of a [[variant]]"
  std::vector<OptionRow> options;
};

std::vector<OptionRow> rows_of(OptionSet& set) {
  return list_options([&](OptionVisitor& visitor) { set.visit(visitor); });
}

/// A table of an experiment file: the members of its struct, then those of free form.
template <class Table>
Described file_table(const std::string& name, const std::vector<OptionRow>& free_form = {}) {
  Table table;
  std::vector<OptionRow> rows =
      list_options([&](OptionVisitor& visitor) { describe(visitor, table); });
  rows.insert(rows.end(), free_form.begin(), free_form.end());
  return {"experiment", name, {}, name, rows};
}

Described describe_method(const Topic& topic, const MethodEntry& method) {
  Described result{"method",
                   topic.name + "/" + method.name,
                   {{"summary", method.summary},
                    {"source", method.source},
                    {"role", method.is_baseline ? "baseline" : "method"}},
                   "options of a [[variant]]",
                   rows_of(*method.default_options())};
  if (!method.gated()) result.facts.emplace_back("not compared by check", method.ungated);
  return result;
}

Described describe_topic(const Topic& topic) {
  Described result{"topic", topic.name, {{"summary", topic.summary}}, "[scene]", {}};
  std::string methods, metrics, diagnostics;
  for (const auto& m : topic.methods) methods += (methods.empty() ? "" : ", ") + m.name;
  for (const MetricEntry& m : metric_rows(topic)) {
    metrics += (metrics.empty() ? "" : ", ") + m.name;
  }
  result.facts.emplace_back("methods", methods);
  for (const auto& d : topic.diagnostics) {
    diagnostics += (diagnostics.empty() ? "" : ", ") + d.name;
  }
  result.facts.emplace_back("metrics", metrics);
  result.facts.emplace_back("diagnostics", diagnostics);
  result.options = rows_of(*topic.default_scene());
  return result;
}

std::string tolerance_text(const Tolerance& tolerance) {
  return rounded_text(tolerance.absolute) + " + " + rounded_text(tolerance.relative) +
         " * |reference|";
}

Described describe_metric(const Topic& topic, const MetricGroup& group, const MetricEntry& metric) {
  Described result{"metric", topic.name + "/" + metric.name, {}, "", {}};
  result.facts = {{"definition", metric.definition},
                  {"unit", metric.unit},
                  {"direction", direction_text(metric.direction)},
                  {"of", group.of_frame ? "a frame" : "the sequence of frames"},
                  {"tolerance", tolerance_text(metric.tolerance)}};
  if (metric.direction == Direction::closer_to_target) {
    result.facts.emplace_back("target", rounded_text(metric.target));
  }
  if (group.needs_reference) result.facts.emplace_back("needs", "a variant with `reference`");
  if (metric.oracle) result.facts.emplace_back("oracle", "an identity or a closed form");
  if (!metric.gated()) result.facts.emplace_back("not compared by check", metric.ungated);
  return result;
}

Described describe_diagnostic(const Topic& topic, const DiagnosticEntry& entry) {
  Described result{"diagnostic",
                   topic.name + "/" + entry.name,
                   {{"definition", entry.definition}, {"unit", entry.unit}, {"of", "a frame"}},
                   "",
                   {}};
  if (entry.counted_work) {
    result.facts.emplace_back("counted work", "check fails when its mean grows by more than " +
                                                  tolerance_text(entry.tolerance));
  }
  if (!entry.metric.empty()) {
    result.facts.emplace_back("measured from outside by", entry.metric);
  } else {
    result.facts.emplace_back("measured by no metric", entry.unmeasured);
  }
  return result;
}

Described describe_file(const Topic& topic, const TopicFile& file) {
  return {"file", topic.name + "/" + file.name, {{"summary", file.summary}}, file.table, file.keys};
}

std::vector<Described> experiment_tables() {
  const OptionRow options{"options", "table", "", "", "", "geoprior describe <method>"};
  const OptionRow at{"at", "table", "", "", "", "one frame by its parameter, { angle_deg = 90 }"};
  const OptionRow values{"values", "array", "required", "", "", "values of the key, one case each"};
  const OptionRow quick_values{
      "quick_values", "array", "", "", "", "values of the key in quick runs"};
  const OptionRow quick{"\"<dotted key>\"",
                        "any",
                        "",
                        "",
                        "",
                        "value in quick runs of scene.*, seed, threads, timing.*, figure_view.*, "
                        "variant.<name>.options.*"};
  return {file_table<HeaderTable>("top of the file"),
          file_table<VariantTable>("[[variant]]", {options}),
          file_table<ClaimTable>("[[claim]]", {at}),
          file_table<SweepTable>("[[sweep]]", {values, quick_values}),
          file_table<StudyTable>("[[study]]"),
          file_table<TimingTable>("[timing]"),
          file_table<ToleranceTable>("[tolerance] metric = { … }"),
          file_table<CheckTable>("[check]"),
          {"experiment", "[quick]", {}, "[quick]", {quick}},
          file_table<FigureViewTable>("[figure_view]", {at})};
}

std::vector<Described> find_described(const std::vector<Topic>& topics, const std::string& name) {
  if (name == "experiment") return experiment_tables();
  std::vector<Described> found;
  std::vector<std::string> names{"experiment"};
  const auto matches = [&](const Topic& topic, const std::string& item) {
    names.push_back(item);
    return name == item || name == topic.name + "/" + item;
  };
  for (const Topic& topic : topics) {
    names.push_back(topic.name);
    if (name == topic.name) found.push_back(describe_topic(topic));
    for (const MethodEntry& method : topic.methods) {
      if (matches(topic, method.name)) found.push_back(describe_method(topic, method));
    }
    for (const MetricGroup& group : topic.metrics) {
      for (const MetricEntry& metric : group.rows) {
        if (matches(topic, metric.name)) found.push_back(describe_metric(topic, group, metric));
      }
    }
    for (const DiagnosticEntry& entry : topic.diagnostics) {
      if (matches(topic, entry.name)) found.push_back(describe_diagnostic(topic, entry));
    }
    for (const TopicFile& file : topic.files) {
      if (matches(topic, file.name)) found.push_back(describe_file(topic, file));
    }
  }
  if (found.empty()) throw Error("unknown name '" + name + "'", "", allowed_names(name, names));
  return found;
}

Json json_of(const Described& described) {
  Json json{{"kind", described.kind}, {"name", described.title}};
  for (const auto& [key, text] : described.facts) json[key] = text;
  json["options"] = Json::array();
  for (const OptionRow& row : described.options) {
    json["options"].push_back({{"key", row.key},
                               {"type", row.type},
                               {"default", row.default_value},
                               {"range", row.range},
                               {"unit", row.unit},
                               {"doc", row.doc},
                               {"when", row.when}});
  }
  return json;
}

void say_described(const Described& described) {
  say(tinted(described.title, Tint::strong) + "  " + tinted(described.kind, Tint::faint));
  for (const auto& [key, text] : described.facts) say("  " + key + ": " + text);
  if (described.kind == "metric" || described.kind == "diagnostic") return;
  if (described.options.empty()) {
    say("  no options");
    return;
  }
  say("  " + described.options_place + ":");
  std::vector<std::vector<std::string>> rows{
      {"key", "type", "default", "range", "unit", "meaning"}};
  for (const OptionRow& row : described.options) {
    rows.push_back({row.key, row.type, row.default_value, row.range, row.unit, row.meaning()});
  }
  say_table(rows, "    ");
}

}  // namespace

int describe_command(const CommandContext& context, const std::string& name, bool markdown) {
  const std::vector<Described> found = find_described(context.topics, name);
  if (context.json) {
    Json json = Json::array();
    for (const Described& described : found) json.push_back(json_of(described));
    print_json(json);
    return done;
  }
  for (const Described& described : found) {
    if (markdown) {
      print_out("### " + described.title + "\n\n" + markdown_table(described.options) + "\n");
    } else {
      say_described(described);
    }
  }
  return done;
}

}  // namespace geoprior
