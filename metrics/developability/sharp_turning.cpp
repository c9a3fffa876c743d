#include "metrics/developability/sharp_turning.h"

#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"

namespace geoprior {

double sharp_turning_share(const TriMesh& mesh, double sharp, const std::vector<bool>& left_out) {
  if (!(sharp > 0))
    throw Error(std::to_string(sharp) + " rad", "sharp turning", "a positive angle");
  if (!left_out.empty() && std::ssize(left_out) != mesh.vertex_count())
    throw Error(std::to_string(left_out.size()) + " values", "sharp turning", "one a vertex");
  const Eigen::MatrixX3d normals = triangle_normals(mesh);
  const EdgeConnectivity edges(mesh.F);
  double in_sharp = 0, all = 0;
  for (int e = 0; e < edges.edge_count(); ++e) {
    const std::span<const int> sides = edges.half_edges(e);
    const auto [a, b] = edges.edge(e);
    if (sides.size() != 2 || (!left_out.empty() && left_out[a] && left_out[b])) continue;
    const Eigen::Vector3d n = normals.row(sides[0] / 3).transpose();
    const Eigen::Vector3d m = normals.row(sides[1] / 3).transpose();
    if (n.isZero() || m.isZero()) continue;
    const double angle = std::atan2(n.cross(m).norm(), n.dot(m));
    const double turning = (mesh.V.row(a) - mesh.V.row(b)).norm() * angle;
    all += turning;
    if (angle > sharp) in_sharp += turning;
  }
  return all > 0 ? in_sharp / all : 0;
}

}  // namespace geoprior
