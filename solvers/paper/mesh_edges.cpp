#include "solvers/paper/mesh_edges.h"

#include <algorithm>
#include <tuple>

namespace geoprior::paper {

MeshEdges::MeshEdges(const Eigen::MatrixX3i& triangles) {
  struct Side {
    int a, b, triangle, corner;
    bool forward;
    bool operator<(const Side& o) const {
      return std::tie(a, b, triangle) < std::tie(o.a, o.b, o.triangle);
    }
  };
  std::vector<Side> sides;
  sides.reserve(triangles.size());
  for (int f = 0; f < triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int u = triangles(f, k), v = triangles(f, (k + 1) % 3);
      sides.push_back({std::min(u, v), std::max(u, v), f, k, u < v});
    }
  }
  std::sort(sides.begin(), sides.end());
  index_.resize(triangles.rows());
  for (const Side& side : sides) {
    if (edges_.empty() || edges_.back().a != side.a || edges_.back().b != side.b) {
      edges_.push_back({side.a, side.b, -1, -1});
    }
    (side.forward ? edges_.back().left : edges_.back().right) = side.triangle;
    index_[side.triangle][side.corner] = static_cast<int>(edges_.size()) - 1;
  }
}

std::optional<int> MeshEdges::find(int u, int v) const {
  const Edge wanted{std::min(u, v), std::max(u, v), -1, -1};
  const auto at = std::lower_bound(
      edges_.begin(), edges_.end(), wanted,
      [](const Edge& x, const Edge& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
  if (at == edges_.end() || at->a != wanted.a || at->b != wanted.b) return std::nullopt;
  return static_cast<int>(at - edges_.begin());
}

}  // namespace geoprior::paper
