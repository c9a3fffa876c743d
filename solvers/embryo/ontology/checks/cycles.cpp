#include <algorithm>
#include <set>

#include "solvers/embryo/ontology/checks/findings.h"

namespace geoprior::embryo {

namespace {

using Successors = std::map<Term, std::vector<Term>>;

/// Leaves the nodes from which a cycle can be reached: those without successors go, again and
/// again. Without recursion, for chains of any length.
void peel(Successors& successors) {
  std::map<Term, std::vector<Term>> predecessors;
  std::map<Term, int> open_successors;
  std::vector<Term> ends;
  for (const auto& [node, next] : successors) {
    for (const Term other : next) {
      predecessors[other].push_back(node);
      if (!successors.contains(other)) ends.push_back(other);
    }
    open_successors[node] = static_cast<int>(next.size());
    if (next.empty()) ends.push_back(node);
  }
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    successors.erase(ends[i]);
    for (const Term node : predecessors[ends[i]]) {
      if (--open_successors[node] == 0) ends.push_back(node);
    }
  }
  for (auto& [node, next] : successors)
    std::erase_if(next, [&](Term other) { return !successors.contains(other); });
}

}  // namespace

std::vector<std::vector<Term>> cycles_of(std::map<Term, std::vector<Term>> successors) {
  std::vector<std::vector<Term>> cycles;
  for (peel(successors); !successors.empty(); peel(successors)) {
    std::vector<Term> path = {successors.begin()->first};
    std::map<Term, int> place = {{path.front(), 0}};
    while (true) {
      const Term next = successors.at(path.back()).front();
      const auto [entry, is_new] = place.try_emplace(next, static_cast<int>(path.size()));
      if (!is_new) {
        path.erase(path.begin(), path.begin() + entry->second);
        break;
      }
      path.push_back(next);
    }
    std::ranges::rotate(path, std::ranges::min_element(path));
    for (const Term node : path) successors.erase(node);
    for (auto& [node, next] : successors)
      std::erase_if(next, [&](Term other) { return !successors.contains(other); });
    cycles.push_back(path);
  }
  return cycles;
}

}  // namespace geoprior::embryo
