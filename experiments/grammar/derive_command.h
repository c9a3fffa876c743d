#pragma once

#include <optional>
#include <string>

#include "testbed/topic.h"

namespace geoprior::grammar {

/// Flags of `geoprior derive`.
struct DeriveOptions {
  std::optional<int> step;  ///< absent: the last
  bool script = false;
  std::string out;  ///< file; empty: standard output
};
void describe(OptionVisitor& v, DeriveOptions& options);

/// `geoprior derive <experiment.toml>`: a dry run of the grammar on one step of the file's scene.
/// Prints the derivation as a tree and what it would touch; nothing is recorded.
TopicCommand derive_command();

}  // namespace geoprior::grammar
