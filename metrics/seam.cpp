#include "metrics/seam.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

struct Side {
  std::array<int, 2> edge;  ///< lower vertex, higher vertex
  int triangle;
};

Eigen::Vector3d doubled_area(const TriMesh& mesh, int t) {
  const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                        c = mesh.V.row(mesh.F(t, 2));
  return (b - a).cross(c - a);
}

/// The sides of all triangles, sorted so that sides of one edge follow one another.
std::vector<Side> sorted_sides(const TriMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(mesh.F.rows()) * 3);
  for (int t = 0; t < mesh.F.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const int a = mesh.F(t, c), b = mesh.F(t, (c + 1) % 3);
      sides.push_back({{std::min(a, b), std::max(a, b)}, t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return x.edge != y.edge ? x.edge < y.edge : x.triangle < y.triangle;
  });
  return sides;
}

}  // namespace

double largest_seam_angle(const TriMesh& mesh, const std::vector<char>& marked) {
  if (static_cast<int>(marked.size()) != mesh.vertex_count()) {
    throw Error(std::to_string(marked.size()) + " marks", "seam angle",
                std::to_string(mesh.vertex_count()) + ", one a vertex");
  }
  const auto is_marked = [&](int t) {
    const auto at = [&](int c) { return marked[mesh.F(t, c)] != 0; };
    return at(0) || at(1) || at(2);
  };
  const std::vector<Side> sides = sorted_sides(mesh);
  double largest = 0;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    if (end - begin != 2) continue;
    const int s = sides[begin].triangle, t = sides[begin + 1].triangle;
    if (is_marked(s) == is_marked(t)) continue;
    const Eigen::Vector3d m = doubled_area(mesh, s), n = doubled_area(mesh, t);
    if (m.norm() == 0 || n.norm() == 0) continue;
    largest = std::max(largest, std::atan2(m.cross(n).norm(), m.dot(n)));
  }
  return largest;
}

}  // namespace geoprior
