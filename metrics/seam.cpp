#include "metrics/seam.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"

namespace geoprior {
namespace {

Eigen::Vector3d doubled_area(const TriMesh& mesh, int t) {
  const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                        c = mesh.V.row(mesh.F(t, 2));
  return (b - a).cross(c - a);
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
  const EdgeConnectivity connectivity(mesh.F);
  double largest = 0;
  for (int e = 0; e < connectivity.edge_count(); ++e) {
    const std::span<const int> both = connectivity.half_edges(e);
    if (both.size() != 2) continue;
    const int s = both[0] / 3, t = both[1] / 3;
    if (is_marked(s) == is_marked(t)) continue;
    const Eigen::Vector3d m = doubled_area(mesh, s), n = doubled_area(mesh, t);
    if (m.norm() == 0 || n.norm() == 0) continue;
    largest = std::max(largest, std::atan2(m.cross(n).norm(), m.dot(n)));
  }
  return largest;
}

}  // namespace geoprior
