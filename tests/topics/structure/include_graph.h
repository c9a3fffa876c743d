#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/topics/structure/source_tree.h"

namespace geoprior::test::structure {

/// Units (unit_of) and the units that their header or source includes, themselves left out. What
/// the tree does not have is no unit.
using IncludeGraph = std::map<std::string, std::set<std::string>>;

IncludeGraph include_graph(const SourceTree& tree);

/// The same with every arrow turned: the units that include each.
IncludeGraph users_of(const IncludeGraph& graph);

/// Sets of units that include each other, directly or by way of others: "a, b, c".
/// Source: Tarjan 1972, strongly connected components.
std::vector<std::string> include_circles(const IncludeGraph& graph);

}  // namespace geoprior::test::structure
