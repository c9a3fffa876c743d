#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace geoprior {

/// Disjoint sets of the numbers 0 … count - 1, each at first in a set of its own (union-find).
///
/// A set is represented by its lowest member, whatever the order of the joins: labels that are
/// given out in the order of the representatives are in the order of the sets' first members.
/// Linking by index and path halving cost O(log count) a call on average over many calls (Tarjan
/// and van Leeuwen 1984).
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  [[nodiscard]] int size() const { return static_cast<int>(parent_.size()); }

  /// Lowest member of the set of `i`. Shortens paths, so that no two threads may ask at once.
  int find(int i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  /// Makes the sets of `i` and `j` one.
  /// @return  lowest member of the joined set
  int join(int i, int j) {
    i = find(i);
    j = find(j);
    const int lowest = std::min(i, j);
    parent_[std::max(i, j)] = lowest;
    return lowest;
  }

 private:
  std::vector<int> parent_;  ///< a member that is not higher; itself for the lowest
};

}  // namespace geoprior
