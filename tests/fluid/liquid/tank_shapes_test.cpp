#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "baselines/fluid/liquid/tank/tank.h"
#include "core/error.h"
#include "core/random.h"

namespace geoprior::fluid {
namespace {

/// A box of 12 triangles, or the same with its winding turned.
TriMesh box_mesh(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  TriMesh mesh;
  mesh.V.resize(8, 3);
  for (int c = 0; c < 8; ++c)
    mesh.V.row(c) =
        centre + Eigen::Vector3d(c & 1 ? half.x() : -half.x(), c & 2 ? half.y() : -half.y(),
                                 c & 4 ? half.z() : -half.z());
  mesh.F.resize(12, 3);
  mesh.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4,
      6, 1, 3, 5, 3, 7, 5;
  return mesh;
}

LiquidShape mesh_shape(TriMesh mesh) {
  LiquidShape shape;
  shape.kind = LiquidShape::Kind::mesh;
  shape.mesh = std::move(mesh);
  return shape;
}

TEST(TankShapes, DistancesOfPrimitivesAreExact) {
  LiquidShape box;
  box.centre = {1, 2, 3};
  box.half_size = {0.5, 1, 2};
  const ShapeDistance to_box(box, 0.1);
  EXPECT_DOUBLE_EQ(to_box({1, 2, 3}), -0.5);
  EXPECT_DOUBLE_EQ(to_box({1.75, 2, 3}), 0.25);
  EXPECT_DOUBLE_EQ(to_box({1.5 + 3, 3 + 4, 3}), 5);  // beside an edge
  LiquidShape cylinder;
  cylinder.kind = LiquidShape::Kind::cylinder;
  cylinder.axis = Eigen::Vector3d::UnitX();
  cylinder.radius = 1;
  cylinder.half_length = 2;
  const ShapeDistance to_cylinder(cylinder, 0.1);
  EXPECT_DOUBLE_EQ(to_cylinder({0, 0, 0}), -1);
  EXPECT_DOUBLE_EQ(to_cylinder({1.75, 0, 0}), -0.25);
  EXPECT_DOUBLE_EQ(to_cylinder({2 + 3, 0, 1 + 4}), 5);  // beside the rim
  EXPECT_TRUE(to_cylinder.bounds().max().isApprox(Eigen::Vector3d(2, 1, 1)));
  LiquidShape plane;
  plane.kind = LiquidShape::Kind::half_space;
  plane.centre = {0, 0, 1};
  EXPECT_DOUBLE_EQ(ShapeDistance(plane, 0.1)({5, 6, 3}), 2);
  EXPECT_FALSE(ShapeDistance(plane, 0.1).bounds().sizes().allFinite());
}

TEST(TankShapes, AMeshHasTheDistanceOfItsShapeNearItsSurface) {
  // Trilinear interpolation of exact values: exact beside flat sides; across the kink at a rib of
  // two planes it errs by up to sqrt(2) / 4 h, a little more at a corner of three.
  const Eigen::Vector3d centre(0.2, 0.1, -0.3), half(0.5, 0.3, 0.4);
  LiquidShape box;
  box.centre = centre;
  box.half_size = half;
  const double h = 0.04;
  const ShapeDistance exact(box, h), sampled(mesh_shape(box_mesh(centre, half)), h);
  RandomStream random(2, "points");
  double largest = 0;
  for (int p = 0; p < 20000; ++p) {
    const Eigen::Vector3d x =
        centre +
        Eigen::Vector3d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5) *
            1.1;
    const double d = exact(x);
    if (std::abs(d) > 2 * h) {
      EXPECT_EQ(sampled(x) > 0, d > 0);
      continue;
    }
    largest = std::max(largest, std::abs(sampled(x) - d));
  }
  EXPECT_LE(largest, 0.4 * h);
  EXPECT_NEAR(sampled(centre + Eigen::Vector3d(0.5 + 0.013, 0.02, 0.01)), 0.013, 1e-6);
  EXPECT_NEAR(sampled(centre + Eigen::Vector3d(0.02, -0.3 + 0.031, 0.01)), -0.031, 1e-6);
}

TEST(TankShapes, FarDistancesOfAMeshFollowTheEikonalEquation) {
  const double h = 0.05;
  const ShapeDistance d(mesh_shape(box_mesh({0, 0, 0}, {1, 1, 1})), h);
  EXPECT_NEAR(d({0, 0, 0}), -1, 2 * h);  // first order inside
  EXPECT_NEAR(d({0.5, 0, 0}), -0.5, h);
  EXPECT_NEAR(d({3, 0, 0}), 2, 0.1);  // beyond the grid: straight to it
  EXPECT_GT(d({3, 3, 3}), 2);
}

TEST(TankShapes, ConcaveMeshesKeepTheirSign) {
  // A thick L: nearest features are a reflex edge and vertices, where face normals mislead.
  TriMesh mesh;
  mesh.V.resize(12, 3);
  const double outline[6][2] = {{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}};
  for (int v = 0; v < 6; ++v)
    for (int z = 0; z < 2; ++z) mesh.V.row(v + 6 * z) << outline[v][0], outline[v][1], 0.5 * z;
  const int caps[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  mesh.F.resize(20, 3);
  for (int t = 0; t < 4; ++t) {
    mesh.F.row(t) << caps[t][0], caps[t][2], caps[t][1];
    mesh.F.row(4 + t) << caps[t][0] + 6, caps[t][1] + 6, caps[t][2] + 6;
  }
  for (int v = 0; v < 6; ++v) {
    const int w = (v + 1) % 6;
    mesh.F.row(8 + 2 * v) << v, w, w + 6;
    mesh.F.row(9 + 2 * v) << v, w + 6, v + 6;
  }
  const ShapeDistance d(mesh_shape(mesh), 0.05);
  RandomStream random(3, "points");
  for (int p = 0; p < 5000; ++p) {
    const Eigen::Vector3d x(1.6 * random.uniform() - 0.3, 1.6 * random.uniform() - 0.3,
                            random.uniform() - 0.25);
    const bool in_outline =
        x.x() > 0 && x.y() > 0 && x.x() < 1 && x.y() < 1 && (x.x() < 0.4 || x.y() < 0.4);
    const bool inside = in_outline && x.z() > 0 && x.z() < 0.5;
    if (std::abs(d(x)) < 0.03) continue;  // interpolation blunts ribs
    EXPECT_EQ(d(x) < 0, inside) << x.transpose();
  }
}

TEST(TankShapes, RefusesAnOpenMesh) {
  TriMesh open = box_mesh({0, 0, 0}, {1, 1, 1});
  open.F.conservativeResize(11, 3);
  EXPECT_THROW(ShapeDistance(mesh_shape(open), 0.1), Error);
  EXPECT_THROW(ShapeDistance(mesh_shape({}), 0.1), Error);
}

TEST(TankShapes, APlacedBodyMovesAndTurnsAboutItsCentre) {
  TankSolid solid;
  solid.shape.centre = {1, 0, 0};
  solid.shape.half_size = {0.5, 0.1, 0.1};
  const double quarter = 0.5 * std::numbers::pi;
  const auto about_z = [](double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  };
  solid.motion = Trajectory{{{0, {0, 0, 0}, about_z(0)},
                             {1, {0, 2, 0}, about_z(quarter)},
                             {2, {0, 4, 0}, about_z(2 * quarter)}}};
  const ShapeDistance distance(solid.shape, 0.1);
  const PlacedSolid placed = place_solid(solid, distance, 1, 1e-6);
  EXPECT_TRUE(placed.centre.isApprox(Eigen::Vector3d(1, 2, 0)));
  // Its long axis now points along y.
  EXPECT_NEAR(placed.distance_at({1, 2.5, 0}), 0, 1e-12);
  EXPECT_NEAR(placed.distance_at({1.3, 2, 0}), 0.2, 1e-12);
  EXPECT_NEAR(placed.linear.y(), 2, 1e-5);
  EXPECT_NEAR(placed.angular.z(), quarter, 1e-5);
  // v + omega x r at a point half a metre up y.
  EXPECT_TRUE(
      placed.velocity_at({1, 2.5, 0}).isApprox(Eigen::Vector3d(-0.5 * quarter, 2, 0), 1e-5));
}

}  // namespace
}  // namespace geoprior::fluid
