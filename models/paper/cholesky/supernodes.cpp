#include "models/paper/cholesky/supernodes.h"

#include <algorithm>
#include <utility>

namespace geoprior::paper {
namespace {

/// Structure of each column below its diagonal: that of the matrix and of the columns whose parent
/// it is.
struct Columns {
  std::vector<int> offset;  ///< n + 1
  std::vector<int> rows;
  std::vector<int> parent;
  [[nodiscard]] std::span<const int> of(int j) const {
    return {rows.data() + offset[j], static_cast<std::size_t>(offset[j + 1] - offset[j])};
  }
};

Columns factor_columns(const BlockMatrix& matrix) {
  const int n = matrix.nodes();
  Columns c;
  c.offset.assign(1, 0);
  c.parent.assign(n, -1);
  c.rows.reserve(matrix.block_count() * 3);
  std::vector<int> seen_by(n, -1), first_child(n, -1), next_child(n, -1);
  for (int j = 0; j < n; ++j) {
    seen_by[j] = j;
    const std::size_t begin = c.rows.size();
    const auto take = [&](int row) {
      if (seen_by[row] == j) return;
      seen_by[row] = j;
      c.rows.push_back(row);
    };
    for (const int row : matrix.column_rows(j)) take(row);
    for (int child = first_child[j]; child >= 0; child = next_child[child]) {
      for (int p = c.offset[child]; p < c.offset[child + 1]; ++p) take(c.rows[p]);
    }
    std::sort(c.rows.begin() + begin, c.rows.end());
    c.offset.push_back(static_cast<int>(c.rows.size()));
    if (c.rows.size() == begin) continue;
    const int parent = c.rows[begin];
    c.parent[j] = parent;
    next_child[j] = std::exchange(first_child[parent], j);
  }
  return c;
}

/// Zeros (blocks) that a front may hold beside its own, of the blocks it stores. Measured on sheets
/// of 200 to 4,096 triangles.
double allowed_zeros(int columns) {
  if (columns <= 4) return 0.8;
  return columns <= 16 ? 0.25 : 0.05;
}

struct Candidate {
  int first, end;
  int below;     ///< rows
  double zeros;  ///< blocks stored in vain
};

double stored(int columns, int below) {
  return columns * (columns + 1) / 2.0 + static_cast<double>(columns) * below;
}

/// Column ranges: fundamental supernodes, then each merged with its last children as far as the
/// zeros allow. A last child stands directly before its parent in postorder.
std::vector<Candidate> merge_columns(const Columns& c) {
  const int n = static_cast<int>(c.parent.size());
  std::vector<Candidate> merged;
  for (int j = 0; j < n;) {
    int end = j + 1;
    while (end < n && c.parent[end - 1] == end && c.of(end).size() + 1 == c.of(end - 1).size()) {
      ++end;
    }
    Candidate here{j, end, static_cast<int>(c.of(end - 1).size()), 0};
    while (!merged.empty() && c.parent[merged.back().end - 1] >= here.first &&
           c.parent[merged.back().end - 1] < here.end) {
      const Candidate& child = merged.back();
      const int columns = here.end - child.first;
      const int added = (here.end - here.first) + here.below - child.below;
      const double zeros =
          here.zeros + child.zeros + static_cast<double>(child.end - child.first) * added;
      if (zeros > allowed_zeros(columns) * stored(columns, here.below)) break;
      here = {child.first, here.end, here.below, zeros};
      merged.pop_back();
    }
    merged.push_back(here);
    j = end;
  }
  return merged;
}

/// Where the rows of a supernode stand in its parent's front.
void place_rows(Supernode& child, const Supernode& parent) {
  child.place.reserve(child.rows.size());
  std::size_t k = 0;
  for (const int row : child.rows) {
    if (row < parent.end) {
      child.place.push_back(row - parent.first);
      continue;
    }
    while (parent.rows[k] != row) ++k;
    child.place.push_back(parent.columns() + static_cast<int>(k));
  }
}

double work(const Supernode& s) {
  double sum = 0;
  for (int k = 0; k < s.columns(); ++k) {
    const double height = s.height() - k;
    sum += height * height;
  }
  return sum;
}

}  // namespace

std::vector<Supernode> find_supernodes(const BlockMatrix& matrix) {
  const Columns columns = factor_columns(matrix);
  const std::vector<Candidate> ranges = merge_columns(columns);
  std::vector<Supernode> supernodes(ranges.size());
  std::vector<int> owner(matrix.nodes());
  for (int s = 0; s < std::ssize(ranges); ++s) {
    supernodes[s].first = ranges[s].first;
    supernodes[s].end = ranges[s].end;
    const auto rows = columns.of(ranges[s].end - 1);
    supernodes[s].rows.assign(rows.begin(), rows.end());
    for (int j = ranges[s].first; j < ranges[s].end; ++j) owner[j] = s;
  }
  for (int s = 0; s < std::ssize(supernodes); ++s) {
    if (supernodes[s].rows.empty()) continue;
    const int parent = owner[supernodes[s].rows.front()];
    supernodes[s].parent = parent;
    supernodes[parent].children.push_back(s);
    place_rows(supernodes[s], supernodes[parent]);
  }
  return supernodes;
}

TreeCut cut_tree(const std::vector<Supernode>& supernodes) {
  // A subtree is split while it is more than this part of all work.
  constexpr double kLargest = 1.0 / 6;
  // Block multiply-adds under which nothing is worth a second thread.
  constexpr double kLeastWork = 4e4;
  const int n = static_cast<int>(supernodes.size());
  std::vector<double> total(n, 0);
  std::vector<int> begin(n);
  double all = 0;
  for (int s = 0; s < n; ++s) {
    const Supernode& node = supernodes[s];
    total[s] += work(node);
    all += work(node);
    begin[s] = node.children.empty() ? s : begin[node.children.front()];
    if (node.parent >= 0) total[node.parent] += total[s];
  }
  TreeCut cut;
  if (all < kLeastWork) {
    if (n > 0) cut.subtrees.push_back({0, n});
    return cut;
  }
  for (int s = n - 1; s >= 0;) {
    if (total[s] > kLargest * all) {
      cut.top.push_back(s--);
    } else {
      cut.subtrees.push_back({begin[s], s + 1});
      s = begin[s] - 1;
    }
  }
  std::reverse(cut.top.begin(), cut.top.end());
  std::reverse(cut.subtrees.begin(), cut.subtrees.end());
  return cut;
}

}  // namespace geoprior::paper
