#pragma once

#include <Eigen/Core>

namespace geoprior {

/// A point of a triangle mesh that goes where the mesh goes: a face and barycentric coordinates
/// (not negative, sum 1) for its three vertices in the order of `F`.
struct SurfacePoint {
  int face = 0;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Constant(1.0 / 3);
};

/// Where a point of the triangles `F` is when their vertices are at the rows of `V`: m, or what
/// else the rows hold.
inline Eigen::Vector3d position_of(const SurfacePoint& point, const Eigen::MatrixX3d& V,
                                   const Eigen::MatrixX3i& F) {
  return (point.barycentric[0] * V.row(F(point.face, 0)) +
          point.barycentric[1] * V.row(F(point.face, 1)) +
          point.barycentric[2] * V.row(F(point.face, 2)))
      .transpose();
}

}  // namespace geoprior
