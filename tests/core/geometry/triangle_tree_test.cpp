#include "core/geometry/triangle_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

Eigen::Vector3d random_point(RandomStream& random) {
  const auto side = [&] { return 3 * random.uniform() - 1.5; };
  const double x = side(), y = side();
  return {x, y, side()};
}

double distance_to_segment(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                           const Eigen::Vector3d& b) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - t * (b - a)).norm();
}

/// Distance from a triangle: from its plane where the foot is inside, else from its edges.
double distance_to_triangle(const Eigen::Vector3d& x, const TriMesh& mesh, int f) {
  std::array<Eigen::Vector3d, 3> p;
  for (int k = 0; k < 3; ++k) p[k] = mesh.V.row(mesh.F(f, k)).transpose();
  const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = p[k], &b = p[(k + 1) % 3];
    inside = inside && n.dot((b - a).cross(x - a)) >= 0;
    nearest = std::min(nearest, distance_to_segment(x, a, b));
  }
  return inside ? std::abs(n.dot(x - p[0])) : nearest;
}

TEST(TriangleTree, NearestPointIsThatOfAllTriangles) {
  const TriMesh mesh = shapes::octahedron();
  const TriangleTree tree(mesh);
  RandomStream random(3);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d x = random_point(random);
    double expected = std::numeric_limits<double>::infinity();
    for (int f = 0; f < mesh.triangle_count(); ++f)
      expected = std::min(expected, distance_to_triangle(x, mesh, f));
    const TriangleTree::Nearest found = tree.nearest(x);
    EXPECT_NEAR(found.distance, expected, 1e-14);
    EXPECT_NEAR(tree.squared_distance(x), expected * expected, 1e-14);
    EXPECT_GE(found.point.barycentric.minCoeff(), 0);
    EXPECT_NEAR((position_of(found.point, mesh.V, mesh.F) - x).norm(), expected, 1e-14);
  }
}

TEST(TriangleTree, BallMeetsTheSurfaceFromItsDistanceOn) {
  const TriangleTree tree(shapes::octahedron());
  const double inner = 1 / std::sqrt(3.0);  // distance of the planes x + y + z = 1 from the centre
  EXPECT_FALSE(tree.meets_ball({0, 0, 0}, 0.999 * inner * inner));
  EXPECT_TRUE(tree.meets_ball({0, 0, 0}, 1.001 * inner * inner));
}

TEST(TriangleTree, SegmentMeetsTheSurfaceItCrosses) {
  const TriangleTree tree(shapes::octahedron());
  EXPECT_TRUE(tree.meets_segment({0.1, 0.1, 0.1}, {1, 1, 1}));
  EXPECT_FALSE(tree.meets_segment({0.1, 0.1, 0.1}, {-0.1, 0.2, 0})) << "inside";
  EXPECT_FALSE(tree.meets_segment({1, 1, 1}, {2, 1, 0})) << "outside";
}

TEST(TriangleTree, TrianglesWithoutAreaAreLeftOutAndFacesKeepTheirNumbers) {
  TriMesh mesh = shapes::octahedron();
  Eigen::MatrixX3i F(mesh.F.rows() + 1, 3);
  F << 0, 0, 2, mesh.F;  // a needle before the others
  mesh.F = F;
  EXPECT_EQ(faces_with_area(mesh), (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8}));
  const TriangleTree tree(mesh);
  const Eigen::Vector3d x(-0.5, -0.4, -0.6);
  const TriangleTree::Nearest found = tree.nearest(x);
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(mesh.V.row(mesh.F(found.point.face, k)).sum(), 0) << "corners on negative axes";
  }
}

TEST(TriangleTree, AnswersFromSeveralThreadsAreThoseOfOne) {
  const TriMesh mesh = shapes::octahedron();
  const TriangleTree tree(mesh), same(mesh);
  RandomStream random(5);
  std::vector<Eigen::Vector3d> points(4096);
  for (Eigen::Vector3d& x : points) x = random_point(random);
  std::vector<double> found(points.size());
  parallel_blocks(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = tree.nearest(points[i]).distance;
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(found[i], same.nearest(points[i]).distance) << i;
  }
}

TEST(TriangleTree, NothingIsNearWithoutTriangles) {
  const TriangleTree tree(TriMesh{});
  EXPECT_THROW((void)tree.nearest({0, 0, 0}), Error);
  EXPECT_THROW((void)tree.squared_distance({0, 0, 0}), Error);
  EXPECT_FALSE(tree.meets_segment({0, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(tree.meets_ball({0, 0, 0}, 1));
}

}  // namespace
}  // namespace geoprior
