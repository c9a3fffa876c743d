#pragma once

#include <Eigen/Geometry>

namespace geoprior {

/// Sum of the normals of triangles, each as long as twice its area: zero for a closed surface,
/// twice the area times the mean normal for a plane one.
inline Eigen::Vector3d doubled_area_vector(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::Vector3d a = V.row(F(t, 0)), b = V.row(F(t, 1)), c = V.row(F(t, 2));
    sum += (b - a).cross(c - a);
  }
  return sum;
}

}  // namespace geoprior
