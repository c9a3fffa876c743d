#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"

namespace geoprior::embryo {

/// `[scene]` of the topic: an ontology, rules, a disease, and the days that are looked at.
struct EmbryoSceneOptions {
  std::string ontology = "urinary.ttl";
  std::vector<std::string> additions;  ///< further files of the same graph
  std::string rules = "development.rules";
  std::string parameter_set = "Ascent";
  std::optional<std::string> disease;
  std::optional<double> from_day, to_day;
  int frames = 6;
  std::vector<double> days;
  std::optional<double> border_step;
  std::vector<std::string> only;
  int copies = 1;
  std::optional<std::string> expected;
  std::optional<std::string> queries;  ///< folder
  bool count_mistakes = false;
};
void describe(OptionVisitor& v, EmbryoSceneOptions& options);

}  // namespace geoprior::embryo
