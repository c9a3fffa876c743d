#include "solvers/fluid/tracking/path_cover.h"

#include <lemon/network_simplex.h>
#include <lemon/smart_graph.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/disjoint_sets.h"
#include "core/error.h"

// A path cover with fewest costs is a matching of largest gain: n nodes without links are n paths,
// and a link joins two of them, which gains c_new - c_ij. So nodes are split into one that a link
// leaves and one that a link enters, and each side is used once. The bipartite graph of links falls
// into parts (with links between consecutive frames only, at least one a pair of frames), each a
// minimum-cost flow of its own.

namespace geoprior::fluid {
namespace {

constexpr double kUnit = 1e-4;  // of costs, which are integers in the flow

struct Gain {
  int from = 0, to = 0;
  long long gain = 0;  // > 0
};

/// Links worth taking, sorted and without doubles.
std::vector<Gain> gains_of(int nodes, const std::vector<PathLink>& links, double new_path_cost) {
  std::vector<Gain> gains;
  for (const PathLink& link : links) {
    if (link.from < 0 || link.to >= nodes || link.from >= link.to || !std::isfinite(link.cost)) {
      throw Error("link " + std::to_string(link.from) + " to " + std::to_string(link.to) +
                      " of cost " + std::to_string(link.cost),
                  "path cover", "from < to, both nodes, finite cost");
    }
    const long long gain = std::llround((new_path_cost - link.cost) / kUnit);
    if (gain > 0) gains.push_back({link.from, link.to, gain});
  }
  std::sort(gains.begin(), gains.end(), [](const Gain& a, const Gain& b) {
    return a.from != b.from ? a.from < b.from : a.to != b.to ? a.to < b.to : a.gain > b.gain;
  });
  gains.erase(
      std::unique(gains.begin(), gains.end(),
                  [](const Gain& a, const Gain& b) { return a.from == b.from && a.to == b.to; }),
      gains.end());
  return gains;
}

/// Gains by connected part of the bipartite graph (leaving node i, entered node n + j), parts in
/// the order of their first gains.
std::vector<std::vector<Gain>> parts_of(int nodes, const std::vector<Gain>& gains) {
  DisjointSets sets(2 * nodes);
  for (const Gain& g : gains) sets.join(g.from, nodes + g.to);
  std::vector<int> part_of(sets.size(), -1);
  std::vector<std::vector<Gain>> parts;
  for (const Gain& g : gains) {
    int& part = part_of[sets.find(g.from)];
    if (part < 0) {
      part = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[part].push_back(g);
  }
  return parts;
}

/// Numbers the values of one side in order.
std::vector<int> distinct(const std::vector<Gain>& part, int Gain::*side) {
  std::vector<int> values;
  for (const Gain& g : part) values.push_back(g.*side);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

int index_of(const std::vector<int>& sorted, int value) {
  return static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin());
}

/// Every leaving node sends one unit, every entered one takes one; a hub takes and gives for free
/// what no link carries.
void solve_part(const std::vector<Gain>& part, std::vector<int>& successor) {
  const std::vector<int> left = distinct(part, &Gain::from), right = distinct(part, &Gain::to);
  const int a = static_cast<int>(left.size()), b = static_cast<int>(right.size());
  lemon::SmartDigraph graph;
  graph.reserveNode(a + b + 1);
  graph.reserveArc(static_cast<int>(part.size()) + a + b);
  for (int i = 0; i < a + b + 1; ++i) graph.addNode();
  const auto node = [&](int i) { return lemon::SmartDigraph::nodeFromId(i); };
  for (const Gain& g : part)
    graph.addArc(node(index_of(left, g.from)), node(a + index_of(right, g.to)));
  for (int i = 0; i < a; ++i) graph.addArc(node(i), node(a + b));
  for (int i = a; i < a + b; ++i) graph.addArc(node(a + b), node(i));
  lemon::NetworkSimplex<lemon::SmartDigraph, long long, long long> simplex(graph);
  lemon::SmartDigraph::ArcMap<long long> cost(graph, 0), upper(graph, 1);
  lemon::SmartDigraph::NodeMap<long long> supply(graph, 0);
  for (int i = 0; i < std::ssize(part); ++i)
    cost[lemon::SmartDigraph::arcFromId(i)] = -part[i].gain;
  for (int i = 0; i < a; ++i) supply[node(i)] = 1;
  for (int i = a; i < a + b; ++i) supply[node(i)] = -1;
  supply[node(a + b)] = b - a;
  simplex.costMap(cost).upperMap(upper).supplyMap(supply);
  if (simplex.run() != simplex.OPTIMAL) throw Error("the flow has no solution", "path cover");
  for (int i = 0; i < std::ssize(part); ++i) {
    if (simplex.flow(lemon::SmartDigraph::arcFromId(i)) > 0) successor[part[i].from] = part[i].to;
  }
}

}  // namespace

std::vector<int> cover_by_paths(int nodes, const std::vector<PathLink>& links,
                                double new_path_cost) {
  std::vector<int> successor(std::max(nodes, 0), -1);
  for (const std::vector<Gain>& part : parts_of(nodes, gains_of(nodes, links, new_path_cost))) {
    if (part.size() == 1) {
      successor[part[0].from] = part[0].to;
    } else {
      solve_part(part, successor);
    }
  }
  return successor;
}

}  // namespace geoprior::fluid
