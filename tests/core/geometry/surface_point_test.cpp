#include "core/geometry/surface_point.h"

#include <gtest/gtest.h>

#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

TEST(SurfacePoint, UnitCoordinatesAreTheCornersOfTheFace) {
  const TriMesh mesh = shapes::octahedron();
  for (int k = 0; k < 3; ++k) {
    const SurfacePoint corner{5, Eigen::Vector3d::Unit(k)};
    EXPECT_EQ(position_of(corner, mesh.V, mesh.F), mesh.V.row(mesh.F(5, k)).transpose());
  }
}

TEST(SurfacePoint, IsTheCentroidUnlessSaidOtherwise) {
  const TriMesh mesh = shapes::octahedron();
  const Eigen::RowVector3d centroid =
      (mesh.V.row(mesh.F(0, 0)) + mesh.V.row(mesh.F(0, 1)) + mesh.V.row(mesh.F(0, 2))) / 3;
  EXPECT_TRUE(position_of({}, mesh.V, mesh.F).isApprox(centroid.transpose(), 1e-15));
}

TEST(SurfacePoint, GoesWhereTheMeshGoes) {
  const TriMesh mesh = shapes::octahedron();
  const SurfacePoint point{3, {0.2, 0.3, 0.5}};
  Eigen::Matrix3d linear;
  linear << 1, 2, 0, -1, 1, 3, 0, 0, 2;
  const Eigen::MatrixX3d moved = mesh.V * linear.transpose();
  EXPECT_TRUE(position_of(point, moved, mesh.F)
                  .isApprox(linear * position_of(point, mesh.V, mesh.F), 1e-14));
}

}  // namespace
}  // namespace geoprior
