#include "models/paper/cholesky/block_matrix.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior::paper {
namespace {

/// The blocks of one column, ascending: its neighbours on the stored side, and itself.
void collect_rows(const NodeGraph& graph, std::span<const int> position, int node,
                  BlockMatrix::Triangle triangle, std::vector<int>& rows) {
  const int column = position[node];
  const std::size_t begin = rows.size();
  for (const int other : graph.neighbours(node)) {
    const int row = position[other];
    if (triangle == BlockMatrix::Triangle::upper ? row < column : row > column) {
      rows.push_back(row);
    }
  }
  rows.push_back(column);
  std::sort(rows.begin() + begin, rows.end());
}

}  // namespace

std::span<const int> NodeGraph::neighbours(int node) const {
  const std::size_t begin = offset[node];
  return {items.data() + begin, offset[node + 1] - begin};
}

NodeGraph couple_groups(int nodes, std::span<const int> offset, std::span<const int> members) {
  const int groups = static_cast<int>(offset.size()) - 1;
  std::vector<int> first(nodes + 1, 0);
  for (const int node : members) ++first[node + 1];
  for (int i = 0; i < nodes; ++i) first[i + 1] += first[i];
  std::vector<int> group_of(members.size());
  std::vector<int> fill(first.begin(), first.end() - 1);
  for (int g = 0; g < groups; ++g) {
    for (int k = offset[g]; k < offset[g + 1]; ++k) {
      group_of[fill[members[k]]++] = g;
    }
  }
  NodeGraph graph;
  graph.offset.assign(1, 0);
  graph.offset.reserve(nodes + 1);
  graph.items.reserve(members.size() * 4);
  std::vector<int> seen_by(nodes, -1);
  for (int i = 0; i < nodes; ++i) {
    seen_by[i] = i;
    for (int p = first[i]; p < first[i + 1]; ++p) {
      const int g = group_of[p];
      for (int k = offset[g]; k < offset[g + 1]; ++k) {
        const int other = members[k];
        if (seen_by[other] == i) continue;
        seen_by[other] = i;
        graph.items.push_back(other);
      }
    }
    graph.offset.push_back(static_cast<int>(graph.items.size()));
  }
  return graph;
}

BlockMatrix::BlockMatrix(const NodeGraph& graph, std::span<const int> position, Triangle triangle)
    : triangle_(triangle), diagonal_(graph.nodes()) {
  const int n = graph.nodes();
  std::vector<int> node_at(n);
  for (int i = 0; i < n; ++i) node_at[position[i]] = i;
  first_.assign(1, 0);
  first_.reserve(n + 1);
  rows_.reserve(graph.items.size() / 2 + static_cast<std::size_t>(n));
  for (int column = 0; column < n; ++column) {
    collect_rows(graph, position, node_at[column], triangle, rows_);
    first_.push_back(static_cast<int>(rows_.size()));
  }
  sparse_.resize(3 * n, 3 * n);
  sparse_.resizeNonZeros(9 * std::ssize(rows_));
  int* outer = sparse_.outerIndexPtr();
  int* inner = sparse_.innerIndexPtr();
  int filled = 0;
  for (int column = 0; column < n; ++column) {
    const int begin = first_[column];
    const int end = first_[column + 1];
    const int before = triangle == Triangle::upper ? end - begin - 1 : 0;
    diagonal_[column] = filled + 3 * before;
    for (int c = 0; c < 3; ++c) {
      outer[3 * column + c] = filled;
      for (int p = begin; p < end; ++p) {
        for (int r = 0; r < 3; ++r) inner[filled++] = 3 * rows_[p] + r;
      }
    }
  }
  outer[3 * n] = filled;
  set_zero();
}

BlockMatrix::Place BlockMatrix::place(int row, int column) const {
  const bool transposed = triangle_ == Triangle::upper ? row > column : row < column;
  if (transposed) std::swap(row, column);
  const auto begin = rows_.begin() + first_[column];
  const auto end = rows_.begin() + first_[column + 1];
  const auto found = std::lower_bound(begin, end, row);
  if (found == end || *found != row) {
    throw Error("no such block in the pattern",
                "row " + std::to_string(row) + ", column " + std::to_string(column));
  }
  const int start = 9 * first_[column] + 3 * static_cast<int>(found - begin);
  return {start, 3 * static_cast<int>(end - begin), transposed};
}

Eigen::Matrix3d BlockMatrix::block(const Place& place) const {
  Eigen::Matrix3d block;
  const double* values = sparse_.valuePtr() + place.start;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) block(r, c) = values[c * place.stride + r];
  }
  if (place.transposed) block.transposeInPlace();
  return block;
}

void BlockMatrix::add(const Place& place, const Eigen::Matrix3d& block) {
  double* values = sparse_.valuePtr() + place.start;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      values[c * place.stride + r] += place.transposed ? block(c, r) : block(r, c);
    }
  }
}

void BlockMatrix::add_to_diagonal(int position, double value) {
  const int blocks = first_[position + 1] - first_[position];
  double* values = sparse_.valuePtr() + diagonal_[position];
  for (int c = 0; c < 3; ++c) values[c * 3 * blocks + c] += value;
}

double BlockMatrix::diagonal_norm() const {
  double sum = 0;
  for (int i = 0; i < nodes(); ++i) {
    const int stride = 3 * (first_[i + 1] - first_[i]);
    const double* values = sparse_.valuePtr() + diagonal_[i];
    for (int c = 0; c < 3; ++c) sum += values[c * stride + c] * values[c * stride + c];
  }
  return std::sqrt(sum);
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  y.setZero(x.size());
  for (int column = 0; column < nodes(); ++column) {
    const int begin = first_[column];
    const int blocks = first_[column + 1] - begin;
    const double* panel = sparse_.valuePtr() + 9 * begin;
    const Eigen::Vector3d here = x.segment<3>(3 * column);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int p = 0; p < blocks; ++p) {
      const int row = rows_[begin + p];
      const Eigen::Map<const Eigen::Matrix3d, 0, Eigen::OuterStride<>> block(
          panel + 3 * p, Eigen::OuterStride<>(3 * blocks));
      sum += block.transpose() * x.segment<3>(3 * row);
      if (row != column) y.segment<3>(3 * row) += block * here;
    }
    y.segment<3>(3 * column) += sum;
  }
}

void BlockMatrix::take_out(std::span<const char> held, std::vector<Taken>& taken) {
  taken.clear();
  for (int column = 0; column < nodes(); ++column) {
    const int begin = first_[column];
    const int blocks = first_[column + 1] - begin;
    const bool column_held = held[column] != 0;
    for (int p = 0; p < blocks; ++p) {
      const int row = rows_[begin + p];
      if (!column_held && held[row] == 0) continue;
      Eigen::Map<Eigen::Matrix3d, 0, Eigen::OuterStride<>> block(values() + 9 * begin + 3 * p,
                                                                 Eigen::OuterStride<>(3 * blocks));
      taken.push_back({row, column, block});
      if (row == column) {
        block.setIdentity();
      } else {
        block.setZero();
      }
    }
  }
}

void multiply_taken(std::span<const BlockMatrix::Taken> taken, const Eigen::VectorXd& x,
                    Eigen::VectorXd& y) {
  for (const BlockMatrix::Taken& t : taken) {
    y.segment<3>(3 * t.row) += t.block * x.segment<3>(3 * t.column);
    if (t.row != t.column) {
      y.segment<3>(3 * t.column) += t.block.transpose() * x.segment<3>(3 * t.row);
    }
  }
}

}  // namespace geoprior::paper
