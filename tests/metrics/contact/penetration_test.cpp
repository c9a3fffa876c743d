#include "metrics/contact/penetration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior {
namespace {

TriMesh moved_mesh(TriMesh mesh, const Eigen::RowVector3d& way) {
  mesh.V.rowwise() += way;
  return mesh;
}

TEST(Penetration, OfSpheresIsTheWayOfOneIntoTheOther) {
  const TriMesh sphere = shapes::sphere(4);
  // Vertices on the axis touch first: the depth is 2 - distance, up to the faces of the other.
  for (const double distance : {1.9, 1.5, 1.2})
    EXPECT_NEAR(penetration(sphere, moved_mesh(sphere, {distance, 0, 0})), 2 - distance, 0.005);
}

TEST(Penetration, IsZeroApartAndBesideEachOther) {
  const TriMesh sphere = shapes::sphere(2);
  EXPECT_EQ(penetration(sphere, moved_mesh(sphere, {2.01, 0, 0})), 0);
  // Boxes meet, spheres do not.
  EXPECT_EQ(penetration(sphere, moved_mesh(sphere, {1.3, 1.3, 1.3})), 0);
}

TriMesh box_mesh(const Eigen::RowVector3d& low, const Eigen::RowVector3d& size) {
  TriMesh mesh;
  mesh.V.resize(8, 3);
  for (int i = 0; i < 8; ++i)
    mesh.V.row(i) = low + size.cwiseProduct(Eigen::RowVector3d(i & 1, i >> 1 & 1, i >> 2));
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6,
      2, 1, 3, 7, 1, 7, 5;
  return mesh;
}

/// A rod enters a box of side 2 by 0.4, 0.75 from the box's other walls.
TEST(Penetration, OfARodInABoxIsTheLengthThatEntered) {
  const TriMesh box = box_mesh({0, 0, 0}, {2, 2, 2});
  EXPECT_NEAR(penetration(box, box_mesh({1.6, 0.75, 0.75}, {3, 0.5, 0.5})), 0.4, 1e-12);
  EXPECT_NEAR(penetration(box, box_mesh({1.6, 1.9, 0.75}, {3, 1, 0.5})), 0.1, 1e-12);
  EXPECT_EQ(penetration(box, box_mesh({2.1, 0.75, 0.75}, {3, 0.5, 0.5})), 0);
}

/// Far inside: the innermost point of the small box is its face at z = 1.1, 0.9 from above.
TEST(Penetration, OfABoxWithinABoxIsTheDepthOfItsInnermostPoint) {
  EXPECT_NEAR(penetration(box_mesh({0, 0, 0}, {9, 9, 2}), box_mesh({4, 4, 1.1}, {1, 1, 0.2})), 0.9,
              1e-12);
}

TEST(Penetration, RefusesPlacesThatAreNotFinite) {
  TriMesh broken = box_mesh({0, 0, 0}, {1, 1, 1});
  broken.V(3, 1) = std::nan("");
  EXPECT_THROW(penetration(broken, box_mesh({0, 0, 0}, {1, 1, 1})), Error);
}

TEST(Penetration, IsTheSameBothWays) {
  const TriMesh a = shapes::sphere(2);
  const TriMesh b = moved_mesh(shapes::sphere(3), {0.3, 1.1, 0.7});
  EXPECT_GT(penetration(a, b), 0);
  EXPECT_EQ(penetration(a, b), penetration(b, a));
}

}  // namespace
}  // namespace geoprior
