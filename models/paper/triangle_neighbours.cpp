#include "models/paper/triangle_neighbours.h"

#include <string>

#include "core/error.h"

namespace geoprior::paper {

std::vector<std::array<int, 3>> triangle_neighbours(const Eigen::MatrixX3i& triangles,
                                                    int vertex_count) {
  const int m = static_cast<int>(triangles.rows());
  std::vector<std::array<int, 3>> result(m, {-1, -1, -1});
  // Directed edges 3 f + k in lists, one for each vertex that they start at.
  std::vector<int> first(vertex_count, -1);
  std::vector<int> next(3 * m, -1);
  const auto end_of = [&](int side) { return triangles(side / 3, (side % 3 + 1) % 3); };
  const auto find = [&](int a, int b) {
    int side = first[a];
    while (side >= 0 && end_of(side) != b) side = next[side];
    return side;
  };
  for (int f = 0; f < m; ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(f, k), b = triangles(f, (k + 1) % 3), side = 3 * f + k;
      if (find(a, b) >= 0) {
        throw Error("two triangles run the same way along an edge",
                    "edge " + std::to_string(a) + " to " + std::to_string(b));
      }
      next[side] = first[a];
      first[a] = side;
      const int other = find(b, a);
      if (other < 0) continue;
      result[f][k] = other / 3;
      result[other / 3][other % 3] = f;
    }
  }
  return result;
}

}  // namespace geoprior::paper
