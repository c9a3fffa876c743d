#pragma once

#include <vector>

namespace geoprior::fluid {

/// Minimum-cost vertex-disjoint path cover of a directed acyclic graph with n nodes: paths cost
/// `new_path_cost` each and links their own cost; every node is in exactly one path. Solved as a
/// minimum-cost flow (network simplex, costs in units of 1e-4).
struct PathLink {
  int from = 0, to = 0;  ///< from < to in time
  double cost = 0;
};
/// @return  successor of every node, -1 at the end of a path
std::vector<int> cover_by_paths(int nodes, const std::vector<PathLink>& links,
                                double new_path_cost);

}  // namespace geoprior::fluid
