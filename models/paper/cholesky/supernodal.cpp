#include "models/paper/cholesky/supernodal.h"

// Multifrontal Cholesky: every supernode gathers its columns of the matrix and the updates of its
// children into a dense front, eliminates its columns, and leaves what remains to its parent.
// Duff, Reid 1983; Liu 1992. Independent subtrees run in parallel.
#include <algorithm>
#include <atomic>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "models/paper/cholesky/dense_front.h"
#include "models/paper/cholesky/supernodes.h"

namespace geoprior::paper {
namespace {

/// First-fit places for updates that live from a supernode to its parent.
class Arena {
 public:
  explicit Arena(std::ptrdiff_t base) : base_(base), end_(base) {}
  std::ptrdiff_t take(std::ptrdiff_t size) {
    std::ptrdiff_t start = base_;
    std::size_t k = 0;
    while (k < live_.size() && live_[k].start < start + size) {
      start = live_[k].start + live_[k].size;
      ++k;
    }
    live_.insert(live_.begin() + k, {start, size});
    end_ = std::max(end_, start + size);
    return start;
  }
  void release(std::ptrdiff_t start) {
    std::erase_if(live_, [&](const Piece& piece) { return piece.start == start; });
  }
  [[nodiscard]] std::ptrdiff_t end() const { return end_; }

 private:
  struct Piece {
    std::ptrdiff_t start, size;
  };
  std::ptrdiff_t base_, end_;
  std::vector<Piece> live_;  ///< ascending
};

class SupernodalCholesky final : public SparseCholesky {
 public:
  explicit SupernodalCholesky(const BlockMatrix& matrix) {
    if (matrix.triangle() != BlockMatrix::Triangle::lower) {
      throw Error("the upper triangle is stored", "supernodal Cholesky", "lower");
    }
    supernodes_ = find_supernodes(matrix);
    cut_ = cut_tree(supernodes_);
    place_fronts();
    place_matrix(matrix);
  }

  bool factorise(const BlockMatrix& matrix) override {
    std::atomic<bool> positive{true};
    for_subtrees([&](int s) {
      if (positive && !eliminate(s, matrix)) positive = false;
    });
    for (const int s : cut_.top) {
      if (positive && !eliminate(s, matrix)) positive = false;
    }
    return positive;
  }

  void solve(Eigen::VectorXd& b) override {
    for_subtrees([&](int s) { forward(s, b); });
    for (const int s : cut_.top) forward(s, b);
    for (auto s = cut_.top.rbegin(); s != cut_.top.rend(); ++s) backward(*s, b);
    parallel_blocks(cut_.subtrees.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        for (int s = cut_.subtrees[t].end - 1; s >= cut_.subtrees[t].begin; --s) backward(s, b);
      }
    });
  }

  [[nodiscard]] long nonzeros() const override { return nonzeros_; }

 private:
  /// Where the numbers of a supernode begin in the shared storage.
  struct Front {
    std::ptrdiff_t panel = 0;   ///< of its columns of the factor, in panels_
    std::ptrdiff_t update = 0;  ///< of what it leaves to its parent, in updates_
    std::ptrdiff_t vector = 0;  ///< of the same in a solve, in vectors_
    int stride = 0, update_stride = 0;
  };

  template <class Body>
  void for_subtrees(const Body& body) {
    parallel_blocks(cut_.subtrees.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        for (int s = cut_.subtrees[t].begin; s < cut_.subtrees[t].end; ++s) body(s);
      }
    });
  }

  void place_fronts() {
    fronts_.resize(supernodes_.size());
    std::ptrdiff_t panels = 0, vectors = 0, updates = 0;
    for (std::size_t s = 0; s < supernodes_.size(); ++s) {
      const Supernode& node = supernodes_[s];
      Front& front = fronts_[s];
      front.stride = front_stride(3 * node.height());
      front.update_stride = front_stride(3 * node.below());
      front.panel = panels;
      front.vector = vectors;
      panels += std::ptrdiff_t{3} * node.columns() * front.stride;
      vectors += 3 * node.below();
      const long columns = 3L * node.columns();
      nonzeros_ += columns * (columns + 1) / 2 + columns * 3 * node.below();
    }
    for (const TreeCut::Range& range : cut_.subtrees) {
      Arena arena(updates);
      for (int s = range.begin; s < range.end; ++s) place_update(s, arena, range.begin);
      updates = arena.end();
    }
    Arena arena(updates);
    for (const int s : cut_.top) place_update(s, arena, -1);
    panels_.resize(panels + kFrontPadding);
    updates_.resize(arena.end() + kFrontPadding);
    vectors_.resize(vectors);
  }

  /// `first`: of the subtree, all of whose updates lie in the arena; -1: the top, whose children
  /// below the cut keep theirs.
  void place_update(int s, Arena& arena, int first) {
    const Supernode& node = supernodes_[s];
    Front& front = fronts_[s];
    const std::ptrdiff_t size = std::ptrdiff_t{3} * node.below() * front.update_stride;
    front.update = arena.take(size);
    for (const int child : node.children) {
      const bool here = first >= 0 || std::binary_search(cut_.top.begin(), cut_.top.end(), child);
      if (here && supernodes_[child].below() > 0) arena.release(fronts_[child].update);
    }
  }

  /// Rows of the matrix's blocks in the fronts.
  void place_matrix(const BlockMatrix& matrix) {
    rows_in_front_.reserve(matrix.block_count());
    for (const Supernode& node : supernodes_) {
      for (int column = node.first; column < node.end; ++column) {
        std::size_t k = 0;
        for (const int row : matrix.column_rows(column)) {
          if (row < node.end) {
            rows_in_front_.push_back(row - node.first);
            continue;
          }
          while (node.rows[k] != row) ++k;
          rows_in_front_.push_back(node.columns() + static_cast<int>(k));
        }
      }
    }
    first_row_.assign(1, 0);
    for (int column = 0; column < matrix.nodes(); ++column) {
      first_row_.push_back(first_row_.back() + static_cast<int>(matrix.column_rows(column).size()));
    }
  }

  bool eliminate(int s, const BlockMatrix& matrix) {
    const Supernode& node = supernodes_[s];
    const Front& front = fronts_[s];
    double* panel = panels_.data() + front.panel;
    double* rest = updates_.data() + front.update;
    const int width = 3 * node.columns(), below = 3 * node.below();
    std::fill_n(panel, std::ptrdiff_t{width} * front.stride, 0.0);
    std::fill_n(rest, std::ptrdiff_t{below} * front.update_stride, 0.0);
    gather(node, front, matrix);
    for (const int child : node.children) take_up(child, node, front);
    if (!factorise_front(panel, front.stride, width + below, width)) return false;
    subtract_outer_product(rest, front.update_stride, panel + width, front.stride, below, width);
    return true;
  }

  void gather(const Supernode& node, const Front& front, const BlockMatrix& matrix) {
    for (int column = node.first; column < node.end; ++column) {
      const int* rows = rows_in_front_.data() + first_row_[column];
      const int blocks = first_row_[column + 1] - first_row_[column];
      const double* from = matrix.column_values(column);
      double* to =
          panels_.data() + front.panel + std::ptrdiff_t{3} * (column - node.first) * front.stride;
      for (int c = 0; c < 3; ++c, to += front.stride) {
        for (int p = 0; p < blocks; ++p, from += 3) std::copy_n(from, 3, to + 3 * rows[p]);
      }
    }
  }

  /// Adds a child's update to the columns and to the update of its parent.
  void take_up(int child, const Supernode& node, const Front& front) {
    const std::vector<int>& place = supernodes_[child].place;
    const int stride = fronts_[child].update_stride;
    const double* from = updates_.data() + fronts_[child].update;
    const int columns = node.columns();
    for (std::size_t k = 0; k < place.size(); ++k) {
      const bool inside = place[k] < columns;
      double* to = inside
                       ? panels_.data() + front.panel + std::ptrdiff_t{3} * place[k] * front.stride
                       : updates_.data() + front.update +
                             std::ptrdiff_t{3} * (place[k] - columns) * front.update_stride -
                             std::ptrdiff_t{3} * columns;
      const int to_stride = inside ? front.stride : front.update_stride;
      for (int c = 0; c < 3; ++c, from += stride, to += to_stride) {
        for (std::size_t a = k; a < place.size(); ++a) {
          const double* block = from + 3 * a;
          double* sum = to + 3 * place[a];
          sum[0] += block[0];
          sum[1] += block[1];
          sum[2] += block[2];
        }
      }
    }
  }

  void forward(int s, Eigen::VectorXd& b) {
    const Supernode& node = supernodes_[s];
    const Front& front = fronts_[s];
    double* x = b.data() + 3 * node.first;
    double* y = vectors_.data() + front.vector;
    std::fill_n(y, 3 * node.below(), 0.0);
    for (const int child : node.children) {
      const std::vector<int>& place = supernodes_[child].place;
      const double* from = vectors_.data() + fronts_[child].vector;
      for (std::size_t k = 0; k < place.size(); ++k) {
        double* to =
            place[k] < node.columns() ? x + 3 * place[k] : y + 3 * (place[k] - node.columns());
        for (std::size_t c = 0; c < 3; ++c) to[c] += from[3 * k + c];
      }
    }
    solve_front(panels_.data() + front.panel, front.stride, 3 * node.height(), 3 * node.columns(),
                x, y);
  }

  void backward(int s, Eigen::VectorXd& b) {
    const Supernode& node = supernodes_[s];
    const Front& front = fronts_[s];
    double* y = vectors_.data() + front.vector;
    for (std::size_t k = 0; k < node.rows.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) y[3 * k + c] = b[3 * node.rows[k] + static_cast<int>(c)];
    }
    solve_front_transposed(panels_.data() + front.panel, front.stride, 3 * node.height(),
                           3 * node.columns(), b.data() + 3 * node.first, y);
  }

  std::vector<Supernode> supernodes_;
  TreeCut cut_;
  std::vector<Front> fronts_;
  std::vector<int> rows_in_front_, first_row_;
  Eigen::VectorXd panels_, updates_, vectors_;
  long nonzeros_ = 0;
};

}  // namespace

std::unique_ptr<SparseCholesky> make_supernodal_cholesky(const BlockMatrix& matrix) {
  return std::make_unique<SupernodalCholesky>(matrix);
}

}  // namespace geoprior::paper
