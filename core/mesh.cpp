#include "core/mesh.h"

#include <Eigen/Geometry>
#include <cmath>

namespace geoprior {

bool same_triangles(const Eigen::MatrixX3i& a, const Eigen::MatrixX3i& b) {
  return a.rows() == b.rows() && a == b;
}

double bounding_box_diagonal(const Eigen::MatrixX3d& V) {
  if (V.rows() == 0) return 0;
  return (V.colwise().maxCoeff() - V.colwise().minCoeff()).norm();
}

double signed_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  if (V.rows() == 0) return 0;
  const Eigen::RowVector3d centre = 0.5 * (V.colwise().maxCoeff() + V.colwise().minCoeff());
  double six_volumes = 0;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::RowVector3d a = V.row(F(t, 0)) - centre;
    const Eigen::RowVector3d b = V.row(F(t, 1)) - centre;
    const Eigen::RowVector3d c = V.row(F(t, 2)) - centre;
    six_volumes += a.dot(b.cross(c));
  }
  return six_volumes / 6;
}

Eigen::MatrixX3d triangle_normals(const TriMesh& mesh) {
  Eigen::MatrixX3d normals(mesh.F.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d ab = mesh.V.row(mesh.F(t, 1)) - a;
    const Eigen::RowVector3d ac = mesh.V.row(mesh.F(t, 2)) - a;
    const Eigen::RowVector3d normal = ab.cross(ac);
    const double length = normal.norm();
    normals.row(t) = length > 0 ? Eigen::RowVector3d(normal / length) : Eigen::RowVector3d::Zero();
  }
  return normals;
}

Eigen::MatrixX3d vertex_normals(const TriMesh& mesh) {
  const Eigen::MatrixX3d face_normals = triangle_normals(mesh);
  Eigen::MatrixX3d normals = Eigen::MatrixX3d::Zero(mesh.V.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.F(t, k);
      const Eigen::RowVector3d to_next = mesh.V.row(mesh.F(t, (k + 1) % 3)) - mesh.V.row(v);
      const Eigen::RowVector3d to_last = mesh.V.row(mesh.F(t, (k + 2) % 3)) - mesh.V.row(v);
      const double angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
      normals.row(v) += angle * face_normals.row(t);
    }
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const double length = normals.row(v).norm();
    if (length > 0) normals.row(v) /= length;
  }
  return normals;
}

Eigen::VectorXd triangle_areas(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  Eigen::VectorXd areas(F.rows());
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::RowVector3d ab = V.row(F(t, 1)) - V.row(F(t, 0));
    const Eigen::RowVector3d ac = V.row(F(t, 2)) - V.row(F(t, 0));
    areas(t) = 0.5 * ab.cross(ac).norm();
  }
  return areas;
}

}  // namespace geoprior
