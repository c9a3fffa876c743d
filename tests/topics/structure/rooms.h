#pragma once

#include <string>
#include <vector>

#include "tests/topics/structure/include_graph.h"
#include "tests/topics/structure/source_tree.h"

namespace geoprior::test::structure {

/// Each check gives a line for everything that breaks the rules of docs/architecture.md.

/// Folders with more headers and sources than that: "core: 26 sources".
std::vector<std::string> crowded_folders(const SourceTree& tree, std::size_t most);

/// Arrows between rooms that point back, includes of a topic that CMake does not say is used, or of
/// its tables, and includes from a folder of experiments/<topic> back to its tables.
std::vector<std::string> arrows_back(const SourceTree& tree);

/// Units of models/<topic> that only baselines, only solvers or only experiments use, where what
/// another unit of models uses counts for that unit's users. Tests and benchmarks do not count.
std::vector<std::string> models_of_one_side(const IncludeGraph& graph);

/// A row of a method table.
struct MethodName {
  std::string topic;
  std::string name;
  bool is_baseline = false;
};

/// Methods without a header of their name (- as _): baselines/<topic>/<name>.h or
/// baselines/<topic>/<name>/<name>.h for a baseline, or experiments/<topic>/<name>.h where it is
/// the method itself with one of its steps exchanged; anywhere below solvers/<topic> for a method.
std::vector<std::string> methods_without_header(const SourceTree& tree,
                                                const std::vector<MethodName>& methods);

}  // namespace geoprior::test::structure
