#include "baselines/embryo/keyframes/keyframes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "baselines/embryo/keyframes/primitive_mesh.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior::embryo {
namespace {

Shape keyed_duct() {
  Shape duct;
  duct.primitive = Primitive::duct;
  duct.points = {{0, 0, 0}, {1, 0.3, 0}, {2, 0, 1}, {2.5, 0, 2}};
  duct.radius = 0.1;
  duct.end_radius = 0.2;
  return duct;
}

Shape keyed_solid(Primitive primitive, const Eigen::Vector3d& radii) {
  Shape shape;
  shape.primitive = primitive;
  shape.radii = radii;
  return shape;
}

TEST(PrimitiveMesh, IsAClosedSphereOfEnoughTriangles) {
  for (const Shape& shape : {keyed_solid(Primitive::ovoid, {1, 2, 3}),
                             keyed_solid(Primitive::cylinder, {0.5, 0.5, 3}), keyed_duct()}) {
    for (const int triangles : {2000, 5000}) {
      const TriMesh mesh = primitive_mesh(shape, triangles);
      EXPECT_GE(mesh.triangle_count(), triangles);
      EXPECT_NO_THROW(require_closed_manifold(mesh, "key frames", "test"));
      EXPECT_EQ(shapes::euler_characteristic(mesh), 2);
      EXPECT_GT(signed_volume(mesh.V, mesh.F), 0);
    }
  }
  EXPECT_EQ(primitive_mesh(keyed_solid(Primitive::point, {0, 0, 0}), 2000).triangle_count(), 0);
}

/// Of the ellipsoid 4/3 pi a b c, of the rod with caps pi r^2 (2 h) + 4/3 pi r^3.
TEST(PrimitiveMesh, HasTheVolumeOfItsSolid) {
  const TriMesh ovoid = primitive_mesh(keyed_solid(Primitive::ovoid, {1, 2, 3}), 8000);
  EXPECT_NEAR(signed_volume(ovoid.V, ovoid.F), 8 * std::numbers::pi, 0.01 * 8 * std::numbers::pi);
  const TriMesh rod = primitive_mesh(keyed_solid(Primitive::cylinder, {0.5, 0.5, 3}), 8000);
  const double volume = std::numbers::pi * (0.25 * 5 + 4.0 / 3 * 0.125);
  EXPECT_NEAR(signed_volume(rod.V, rod.F), volume, 0.02 * volume);
}

TEST(PrimitiveMesh, OfAHalfEndsAtTheWallOfItsCut) {
  Half half;
  half.shape = keyed_solid(Primitive::ovoid, {1, 1, 1});
  half.cut.normal = {0, 1, 0};
  half.cut.thickness = 0.2;
  half.sign = -1;
  const TriMesh mesh = half_mesh(half, 2000);
  EXPECT_NEAR(mesh.V.col(1).maxCoeff(), -0.1, 1e-15);
  EXPECT_NEAR(mesh.V.col(1).minCoeff(), -1, 1e-12);
  EXPECT_NO_THROW(require_closed_manifold(mesh, "key frames", "test"));
}

/// A ball in two stages (middles 1 and 4): at rest in the first, away and larger in the second.
struct TwoStages {
  std::vector<Stage> stages{{"A", "A", 0, 0, 2}, {"B", "B", 1, 2, 6}};
  std::vector<DayState> states{2};

  TwoStages() {
    for (int i = 0; i < 2; ++i) {
      Shape shape = keyed_solid(Primitive::ovoid, Eigen::Vector3d::Constant(1 + 3 * i));
      shape.center.x() = 10 * i;
      states[i].day = stages[i].middle();
      states[i].structures.push_back({7, shape});
    }
  }
};

TEST(Keyframes, MoveEveryVertexOnAStraightLine) {
  const TwoStages two;
  const Keyframes keyframes(two.states, two.stages);
  const Eigen::MatrixX3d first = keyframes.at(1)[0].mesh.V, last = keyframes.at(4)[0].mesh.V;
  EXPECT_EQ(keyframes.at(0.5)[0].mesh.V, first);
  EXPECT_EQ(keyframes.at(6)[0].mesh.V, last);
  for (const double u : {0.2, 0.5, 0.9})
    EXPECT_LT((keyframes.at(1 + 3 * u)[0].mesh.V - ((1 - u) * first + u * last)).norm(), 1e-12);
}

/// A ring that turns by 90 degrees from key to key is cos 45 degrees as wide half-way.
TEST(Keyframes, ThinWhatTurnsBetweenThem) {
  TwoStages two;
  two.states[0].structures[0].shape = two.states[1].structures[0].shape;
  two.states[1].structures[0].shape.axes =
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Keyframes keyframes(two.states, two.stages);
  const Eigen::VectorXd x = keyframes.at(2.5)[0].mesh.V.col(0).array() - 10;
  EXPECT_NEAR(x.cwiseAbs().maxCoeff(), 4 * std::numbers::sqrt2 / 2, 1e-2);
}

TEST(Keyframes, OnlyHideWhatTheyAreToldToAndRefuseOtherDays) {
  TwoStages two;
  two.states[1].structures.push_back({8, keyed_solid(Primitive::ovoid, {1, 1, 1})});
  const Keyframes keyframes(two.states, two.stages);
  EXPECT_EQ(keyframes.at(1.9).size(), 1U);
  EXPECT_EQ(keyframes.at(2).size(), 2U);
  std::vector<bool> hidden(9, false);
  hidden[7] = true;
  ASSERT_EQ(keyframes.at(3, hidden).size(), 1U);
  EXPECT_EQ(keyframes.at(3, hidden)[0].structure, 8);
  EXPECT_THROW((void)keyframes.at(6.1), Error);
  EXPECT_THROW(Keyframes({two.states.data(), 1}, two.stages), Error);
  EXPECT_GT(keyframes.bytes(), 3U * 1000 * 3 * sizeof(double));
}

}  // namespace
}  // namespace geoprior::embryo
