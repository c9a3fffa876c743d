#include "testbed/runner/spec/json.h"

#include <nlohmann/json.hpp>

namespace geoprior {

using Json = nlohmann::ordered_json;

Json json_of(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::Kind::boolean:
      return node.boolean;
    case TomlNode::Kind::integer:
      return node.integer;
    case TomlNode::Kind::real:
      return node.real;
    case TomlNode::Kind::text:
      return node.text;
    case TomlNode::Kind::array: {
      Json array = Json::array();
      for (const TomlNode& item : node.items) array.push_back(json_of(item));
      return array;
    }
    case TomlNode::Kind::table: {
      Json table = Json::object();
      for (std::size_t i = 0; i < node.keys.size(); ++i) {
        table[node.keys[i]] = json_of(node.items[i]);
      }
      return table;
    }
  }
  return nullptr;
}

namespace {

/// The JSON text of an option set or value; the text itself should it be none.
Json embedded(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_discarded() ? Json(text) : json;
}

Json variant_json(const VariantSpec& variant) {
  return {{"name", variant.name},
          {"method", variant.method},
          {"role", variant.role},
          {"reference", variant.reference ? Json(*variant.reference) : Json(nullptr)},
          {"options", embedded(variant.options_json)}};
}

Json case_json(const CaseSpec& spec) {
  Json swept = Json::object();
  for (const auto& [key, value] : spec.swept) swept[key] = embedded(value);
  Json variants = Json::array();
  for (const VariantSpec& variant : spec.variants) variants.push_back(variant_json(variant));
  return {{"name", spec.name},
          {"swept", swept},
          {"seed", spec.seed},
          {"threads", spec.threads},
          {"scene", embedded(spec.scene_json)},
          {"variants", variants}};
}

}  // namespace

std::string spec_json(const Experiment& experiment) {
  Json cases = Json::array();
  for (const CaseSpec& spec : experiment.cases) cases.push_back(case_json(spec));
  Json json{{"id", experiment.id},
            {"title", experiment.title},
            {"figure", experiment.figure},
            {"topic", experiment.topic},
            {"quick", experiment.quick},
            {"hash", experiment.hash},
            {"timing_repetitions", experiment.timing_repetitions},
            {"cases", cases}};
  if (experiment.timing_warm_up) json["timing_warm_up"] = *experiment.timing_warm_up;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace geoprior
