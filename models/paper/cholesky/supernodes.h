#pragma once

#include <span>
#include <vector>

#include "models/paper/cholesky/block_matrix.h"

namespace geoprior::paper {

/// Columns of a Cholesky factor with (nearly) the same rows, eliminated together as one dense
/// front. All indices are positions (block rows).
struct Supernode {
  int first = 0, end = 0;  ///< columns
  int parent = -1;         ///< supernode that takes up the update; -1: none
  std::vector<int> rows;   ///< below the columns, ascending
  std::vector<int> place;  ///< of `rows` in the parent's front, its own columns counted first
  std::vector<int> children;

  [[nodiscard]] int columns() const { return end - first; }
  [[nodiscard]] int below() const { return static_cast<int>(rows.size()); }
  [[nodiscard]] int height() const { return columns() + below(); }
};

/// Symbolic factorisation of a lower block matrix in postorder: structure of the factor, columns
/// gathered into supernodes, small ones merged with their parents when that adds few zeros
/// (fewer, larger dense operations).
std::vector<Supernode> find_supernodes(const BlockMatrix& matrix);

/// Subtrees that can be eliminated independently, as ranges of supernodes, and the supernodes above
/// them. Depends on the tree alone, not on the number of threads.
struct TreeCut {
  struct Range {
    int begin, end;
  };
  std::vector<Range> subtrees;
  std::vector<int> top;  ///< ascending
};
TreeCut cut_tree(const std::vector<Supernode>& supernodes);

}  // namespace geoprior::paper
