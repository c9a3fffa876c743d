#include "metrics/volume/closedness.h"

#include <gtest/gtest.h>

#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

TEST(Closedness, OfClosedSurfacesHasNoDefect) {
  const Closedness sphere = closedness(shapes::sphere(1, {0, 0, 0}, 2));
  EXPECT_EQ(sphere.defects(), 0);
  EXPECT_EQ(sphere.components, 1);
  EXPECT_EQ(sphere.euler_characteristic, 2);
  const Closedness both =
      closedness(shapes::together(shapes::sphere(1, {0, 0, 0}, 2), shapes::torus(3, 1, 12, 8)));
  EXPECT_EQ(both.defects(), 0);
  EXPECT_EQ(both.components, 2);
  EXPECT_EQ(both.euler_characteristic, 2);  // 2 + 0
  EXPECT_EQ(closedness(TriMesh{}).defects(), 0);
}

TEST(Closedness, CountsTheBorderOfAMissingTriangle) {
  TriMesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
  mesh.F.conservativeResize(mesh.F.rows() - 1, 3);
  const Closedness open = closedness(mesh);
  EXPECT_EQ(open.border_edges, 3);
  EXPECT_EQ(open.crowded_edges + open.turned_edges + open.pinched_vertices, 0);
}

TEST(Closedness, CountsTheEdgesOfATriangleTurnedOver) {
  TriMesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
  std::swap(mesh.F(4, 0), mesh.F(4, 1));
  EXPECT_EQ(closedness(mesh).turned_edges, 3);
}

TEST(Closedness, FindsTwoBoxesThatShareAnEdgeOrACorner) {
  // Cubes whose common edge is one edge of the mesh: four triangles meet there.
  const TriMesh two =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({1, 1, 0}, {2, 2, 1}));
  // Vertices 3, 7 of the first (x = y = 1) are 8, 12 of the second.
  TriMesh edge = two;
  for (int& v : edge.F.reshaped()) v = v == 8 ? 3 : v == 12 ? 7 : v;
  EXPECT_EQ(closedness(edge).crowded_edges, 1);
  TriMesh corner = two;
  for (int& v : corner.F.reshaped()) v = v == 8 ? 3 : v;
  const Closedness pinched = closedness(corner);
  EXPECT_EQ(pinched.crowded_edges, 0);
  EXPECT_EQ(pinched.pinched_vertices, 1);
}

TEST(LargestComponent, IsTheOneWithTheMostTriangles) {
  const TriMesh sphere = shapes::sphere(1, {0, 0, 0}, 1);
  const TriMesh box = shapes::box({5, 0, 0}, {6, 1, 1});
  const TriMesh both = shapes::together(box, sphere);
  const Eigen::MatrixX3i kept = largest_component(both);
  EXPECT_EQ(kept, both.F.bottomRows(sphere.F.rows()));
  EXPECT_EQ(largest_component(TriMesh{}).rows(), 0);
}

}  // namespace
}  // namespace geoprior
