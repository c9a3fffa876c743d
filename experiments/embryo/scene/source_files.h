#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/embryo/scene/options.h"
#include "solvers/embryo/triples/graph.h"
#include "solvers/embryo/triples/read.h"

namespace geoprior::embryo {

/// The texts that a scene is made of.
struct SourceFiles {
  struct Triples {
    std::string where, bytes;
    RdfFormat format = RdfFormat::turtle;
  };
  std::vector<Triples> triples;  ///< the ontology, then the additions
  std::string rules, rules_where;
  std::vector<std::string> queries;  ///< q1.rq, q2.rq, … as SPARQL; none where no folder is named
  std::vector<std::filesystem::path> paths;  ///< of all that was read
};

/// @throws Error  naming the file: missing, too large, of an extension that no reader has
SourceFiles read_source_files(const EmbryoSceneOptions& options,
                              const std::filesystem::path& folder);

/// All files in one graph, sorted. @throws Error  naming file and line
Graph read_graph_of(const SourceFiles& files);

/// The graph and `copies - 1` more of it, in which each thing that the graph says something of has
/// another name: `LeftUreter` is `LeftUreter_2`, `LeftUreter_3`, … Stages and sources are common to
/// all.
Graph replicated(const Graph& graph, int copies);

}  // namespace geoprior::embryo
