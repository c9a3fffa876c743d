#pragma once

#include <optional>
#include <string>

#include "core/options.h"
#include "experiments/embryo/sparql/run_sparql.h"
#include "testbed/topic.h"

namespace geoprior::embryo {

/// Flags of `geoprior query`.
struct QueryOptions {
  std::string query;  ///< file
  SparqlOptions::Format format = SparqlOptions::Format::csv;
  double timeout_s = 60;
  int memory_mb = 2000;
  std::optional<std::string> disease = {};
};
void describe(OptionVisitor& v, QueryOptions& options);

/// `geoprior query <experiment> <file.rq>`: answers a SPARQL query over the graph of an
/// experiment's scene, saturated under its disease or another one. Nothing is recorded.
TopicCommand query_command();

}  // namespace geoprior::embryo
