#include "models/paper/shell/state.h"

#include <Eigen/Geometry>

#include "core/geometry/planar.h"

namespace geoprior::paper {

double pattern_area(const ShellMesh& mesh, int t) {
  const Eigen::Vector2d a = mesh.pattern.row(mesh.triangles(t, 0));
  const Eigen::Vector2d b = mesh.pattern.row(mesh.triangles(t, 1));
  const Eigen::Vector2d c = mesh.pattern.row(mesh.triangles(t, 2));
  return cross(b - a, c - a) / 2;
}

Eigen::Vector3d vertex_normal(const ShellState& state, const VertexCorners& corners, int vertex) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int corner : corners.of(vertex)) {
    const Eigen::RowVector3i t = state.mesh.triangles.row(corner / 3);
    const Eigen::Vector3d a = state.x.row(t[0]), b = state.x.row(t[1]), c = state.x.row(t[2]);
    sum += (b - a).cross(c - a);
  }
  return sum.normalized();
}

}  // namespace geoprior::paper
