// What the tests of experiment files have in common.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/runner/spec/spec.h"
#include "tests/testbed/toy_home.h"

namespace geoprior::test {

using nlohmann::json;

/// The request of a run that is quick or full.
inline LoadRequest sized(bool quick) {
  LoadRequest request;
  request.quick = quick;
  return request;
}

inline LoadRequest only(std::vector<std::string> variants) {
  LoadRequest request;
  request.variants = std::move(variants);
  return request;
}

inline LoadRequest with(std::vector<std::string> sets, std::optional<int> threads = {}) {
  LoadRequest request;
  request.sets = std::move(sets);
  request.threads = threads;
  return request;
}

inline std::string disc_with(const std::string& more) { return toy::disc_experiment() + more; }

/// Loads texts as the experiment toy-circle/disc.
class SpecTest : public ::testing::Test {
 protected:
  Experiment load(const std::string& text, const LoadRequest& request = {}) {
    return load_experiment(home_.write("experiments/toy-circle/disc.toml", text), topics_, request);
  }
  std::string error_of(const std::string& text, const LoadRequest& request = {}) {
    try {
      (void)load(text, request);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  static std::vector<std::string> case_names(const Experiment& experiment) {
    std::vector<std::string> names;
    for (const CaseSpec& c : experiment.cases) names.push_back(c.name);
    return names;
  }
  static json options(const Experiment& e, std::size_t c, std::size_t v) {
    return json::parse(e.cases.at(c).variants.at(v).options_json);
  }

  toy::Home home_;
  std::vector<Topic> topics_ = toy::topics();
};

inline constexpr const char* kSweep = R"(
[[sweep]]
key = "variant.polygon.options.segments"
values = [8, 32]
quick_values = [8]
)";

}  // namespace geoprior::test
