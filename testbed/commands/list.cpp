#include <nlohmann/json.hpp>

#include "testbed/catalogue.h"
#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/runner/judgement/measure.h"

namespace geoprior {
namespace {

using Json = nlohmann::ordered_json;

Json topic_json(const Topic& topic) {
  Json json{{"name", topic.name}, {"summary", topic.summary}};
  json["methods"] = Json::array();
  for (const MethodEntry& method : topic.methods) {
    json["methods"].push_back({{"name", method.name},
                               {"baseline", method.is_baseline},
                               {"summary", method.summary},
                               {"source", method.source}});
  }
  json["metrics"] = Json::array();
  for (const MetricEntry& metric : metric_rows(topic)) {
    json["metrics"].push_back({{"name", metric.name},
                               {"unit", metric.unit},
                               {"definition", metric.definition},
                               {"direction", direction_text(metric.direction)},
                               {"oracle", metric.oracle},
                               {"gated", metric.gated()}});
  }
  return json;
}

void say_topic(const Topic& topic) {
  say("\n" + tinted(topic.name, Tint::strong) + "  " + topic.summary);
  std::vector<std::vector<std::string>> methods{{"method", "role", "what it does", "source"}};
  for (const MethodEntry& m : topic.methods) {
    methods.push_back({m.name, m.is_baseline ? "baseline" : "method", m.summary, m.source});
  }
  say_table(methods);
  std::vector<std::vector<std::string>> metrics{{"metric", "unit", "definition"}};
  for (const MetricEntry& m : metric_rows(topic)) metrics.push_back({m.name, m.unit, m.definition});
  say();
  say_table(metrics);
}

}  // namespace

int list_command(const CommandContext& context) {
  const std::vector<CatalogueEntry> experiments = catalogue();
  if (context.json) {
    Json json{{"experiments", Json::array()}, {"topics", Json::array()}};
    for (const CatalogueEntry& e : experiments) {
      json["experiments"].push_back({{"id", e.id},
                                     {"title", e.title},
                                     {"figure", e.figure},
                                     {"topic", e.topic},
                                     {"file", e.file.string()}});
    }
    for (const Topic& topic : context.topics) json["topics"].push_back(topic_json(topic));
    print_json(json);
    return done;
  }
  std::vector<std::vector<std::string>> rows{{"experiment", "figure", "title"}};
  for (const CatalogueEntry& e : experiments) rows.push_back({e.id, e.figure, e.title});
  say_table(rows, "");
  for (const Topic& topic : context.topics) say_topic(topic);
  say("\ngeoprior describe <method>  shows its options;  geoprior run <experiment>  makes a run");
  return done;
}

}  // namespace geoprior
