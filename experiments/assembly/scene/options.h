#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/assembly/search/input.h"

namespace geoprior::assembly {

/// Connected pieces that are cut out of the models at random, in place of them.
struct PiecesOptions {
  int count = 100;
  int least = 12;
  int most = 40;
};
void describe(OptionVisitor& v, PiecesOptions& options);

/// The `[scene]` table of the topic.
struct AssemblySceneOptions {
  std::vector<std::string> inputs;
  std::vector<std::string> models;
  int least_parts = 1;
  int most_parts = 100000;
  std::optional<PiecesOptions> pieces;
  Rules rules;
  Guide guide;
  std::optional<Survey> survey;
};
void describe(OptionVisitor& v, AssemblySceneOptions& options);
void describe(OptionVisitor& v, Survey& options);

}  // namespace geoprior::assembly
