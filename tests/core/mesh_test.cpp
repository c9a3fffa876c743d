#include "core/mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

TEST(Mesh, VolumesOfPolyhedraAreExact) {
  const TriMesh tetrahedron = shapes::tetrahedron();
  EXPECT_NEAR(signed_volume(tetrahedron.V, tetrahedron.F), 1.0 / 6, 1e-16);
  const TriMesh octahedron = shapes::octahedron();
  EXPECT_NEAR(signed_volume(octahedron.V, octahedron.F), 4.0 / 3, 1e-15);
  // Far from the origin only the rounding of the positions is left.
  const Eigen::MatrixX3d far = octahedron.V.rowwise() + Eigen::RowVector3d(1e6, -1e6, 1e6);
  EXPECT_NEAR(signed_volume(far, octahedron.F), 4.0 / 3, 1e-9);
  const Eigen::MatrixX3i inside_out = octahedron.F.rowwise().reverse();
  EXPECT_NEAR(signed_volume(octahedron.V, inside_out), -4.0 / 3, 1e-15);
}

TEST(Mesh, AreasOfASquareSumToOne) {
  const TriMesh mesh = shapes::square(5);
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  EXPECT_NEAR(areas.sum(), 1, 1e-15);
  EXPECT_NEAR(areas.maxCoeff(), 0.02, 1e-16);
}

TEST(Mesh, TriangleListsOfDifferentLengthsAreNotTheSame) {
  const Eigen::MatrixX3i all = shapes::octahedron().F, none(0, 3);
  Eigen::MatrixX3i turned = all;
  turned.row(7) << all(7, 1), all(7, 2), all(7, 0);
  EXPECT_TRUE(same_triangles(all, shapes::octahedron().F));
  EXPECT_TRUE(same_triangles(none, none));
  EXPECT_FALSE(same_triangles(all, all.topRows(7)));
  EXPECT_FALSE(same_triangles(all.topRows(7), all));
  EXPECT_FALSE(same_triangles(none, all));
  EXPECT_FALSE(same_triangles(all, turned)) << "the same triangle from another corner";
}

TEST(Mesh, NormalsPointOutwards) {
  const TriMesh mesh = shapes::octahedron();
  const Eigen::MatrixX3d normals = vertex_normals(mesh);
  // By symmetry those of the octahedron are its vertices.
  EXPECT_LE((normals - mesh.V).norm(), 1e-14);
  const Eigen::MatrixX3d faces = triangle_normals(mesh);
  for (Eigen::Index t = 0; t < faces.rows(); ++t) {
    EXPECT_NEAR(faces.row(t).norm(), 1, 1e-15);
    EXPECT_NEAR(faces.row(t).cwiseAbs().minCoeff(), 1 / std::sqrt(3.0), 1e-15);
  }
}

TEST(Mesh, AngleWeightsMakeVertexNormalsIndependentOfTheTriangulation) {
  // A cube corner: two of its three square faces may be cut through the corner or not.
  TriMesh mesh;
  mesh.V.resize(7, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1;
  mesh.F.resize(6, 3);
  mesh.F << 0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 5, 4, 0, 4, 3, 4, 6, 3;
  const Eigen::RowVector3d normal = vertex_normals(mesh).row(0);
  EXPECT_LE((normal + Eigen::RowVector3d::Constant(1 / std::sqrt(3.0))).norm(), 1e-14);
}

TEST(Mesh, DegenerateTrianglesAndLoneVerticesGetZeroNormals) {
  TriMesh mesh;
  mesh.V = Eigen::MatrixX3d::Zero(4, 3);
  mesh.V(1, 0) = 1;
  mesh.V(2, 0) = 2;
  mesh.F.resize(1, 3);
  mesh.F << 0, 1, 2;
  EXPECT_EQ(triangle_normals(mesh).norm(), 0);
  EXPECT_EQ(vertex_normals(mesh).norm(), 0);
}

TEST(Mesh, BoxDiagonal) {
  EXPECT_EQ(bounding_box_diagonal(Eigen::MatrixX3d(0, 3)), 0);
  EXPECT_NEAR(bounding_box_diagonal(shapes::octahedron().V), std::sqrt(12.0), 1e-15);
}

}  // namespace
}  // namespace geoprior
