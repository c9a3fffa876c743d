#include "models/paper/meshing/transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "baselines/paper/dense.h"
#include "core/error.h"
#include "core/random.h"
#include "models/paper/contact/overlap.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/pattern_locator.h"
#include "tests/paper/contact/plane_shapes.h"

namespace geoprior::paper {
namespace {

ShellState state_on(ShellMesh mesh) {
  ShellState state;
  state.mesh = std::move(mesh);
  const int n = state.mesh.vertex_count(), m = state.mesh.triangle_count();
  state.x = Eigen::MatrixX3d::Zero(n, 3);
  state.v = Eigen::MatrixX3d::Zero(n, 3);
  state.plastic_curvature = Eigen::MatrixX3d::Zero(m, 3);
  state.damage = Eigen::VectorXd::Zero(m);
  state.time = 0.7;
  return state;
}

/// A sheet with linear positions and velocities and a crease of random depth on a third of it.
ShellState sample_state(const Pattern& pattern, int triangles) {
  ShellState state = state_on(uniform_mesh(pattern, triangles, UniformLayout::delaunay, {}, 5));
  Eigen::Matrix<double, 2, 3> a, b;
  a << 1, 2, -1, 0.5, 1, 3;
  b << -2, 0, 1, 4, 1, 1;
  state.x = state.mesh.pattern * a;
  state.v = state.mesh.pattern * b;
  state.v.rowwise() += Eigen::RowVector3d(0.1, 0.2, 0.3);
  RandomStream random(1, "creases");
  for (int f = 0; f < state.mesh.triangle_count(); f += 3) {
    for (int k = 0; k < 3; ++k) state.plastic_curvature(f, k) = 100 * random.normal();
    state.damage[f] = random.uniform();
  }
  return state;
}

Eigen::Vector4d crease_integrals(const ShellState& state) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    const double area = plane_shapes::twice_area(state.mesh, f) / 2;
    sum.head<3>() += area * state.plastic_curvature.row(f).transpose();
    sum[3] += area * state.damage[f];
  }
  return sum;
}

TEST(TransferState, ReproducesLinearFields) {
  for (const Pattern& pattern : {rectangle_pattern(0.2, 0.3), plane_shapes::ell_pattern()}) {
    const ShellState from = sample_state(pattern, 150);
    const ShellMesh mesh = uniform_mesh(pattern, 260, UniformLayout::equilateral, {}, 1);
    const ShellState to = transfer_state(from, mesh);
    Eigen::Matrix<double, 2, 3> a, b;
    a << 1, 2, -1, 0.5, 1, 3;
    b << -2, 0, 1, 4, 1, 1;
    EXPECT_LT((to.x - mesh.pattern * a).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT(((to.v - mesh.pattern * b).rowwise() - Eigen::RowVector3d(0.1, 0.2, 0.3))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-14);
    EXPECT_EQ(to.time, from.time);
  }
}

TEST(TransferState, ConservesTheIntegralOfTheCreases) {
  for (const Pattern& pattern : {rectangle_pattern(0.2, 0.3), plane_shapes::ell_pattern()}) {
    const ShellState from = sample_state(pattern, 150);
    const ShellState to =
        transfer_state(from, uniform_mesh(pattern, 260, UniformLayout::equilateral, {}, 1));
    const Eigen::Vector4d before = crease_integrals(from), after = crease_integrals(to);
    EXPECT_LT((after - before).norm(), 1e-12 * before.norm());
  }
}

TEST(TransferState, KeepsConstantCreasesConstant) {
  const Pattern pattern = rectangle_pattern(0.2, 0.3);
  ShellState from = sample_state(pattern, 150);
  from.plastic_curvature.rowwise() = Eigen::RowVector3d(10, -20, 30);
  from.damage.setConstant(2);
  const ShellState to =
      transfer_state(from, uniform_mesh(pattern, 90, UniformLayout::structured, {}, 1));
  EXPECT_LT((to.plastic_curvature.rowwise() - Eigen::RowVector3d(10, -20, 30)).norm(), 1e-9);
  EXPECT_LT((to.damage.array() - 2).abs().maxCoeff(), 1e-11);
}

TEST(TransferState, ToTheSameMeshChangesNoVertex) {
  const ShellState from = sample_state(disc_pattern(0.1, 30), 150);
  const ShellState to = transfer_state(from, from.mesh);
  EXPECT_EQ(to.x, from.x);
  EXPECT_EQ(to.v, from.v);
  EXPECT_LT((to.plastic_curvature - from.plastic_curvature).norm(), 1e-10);
}

TEST(TransferState, RefusesAVertexOutside) {
  const ShellState from = sample_state(rectangle_pattern(0.2, 0.3), 50);
  const ShellMesh larger =
      uniform_mesh(rectangle_pattern(0.2002, 0.3), 50, UniformLayout::structured, {}, 1);
  EXPECT_THROW(transfer_state(from, larger), Error);
}

TEST(PatternLocator, FindsTheTriangleOfEveryPoint) {
  const ShellMesh mesh =
      uniform_mesh(plane_shapes::ell_pattern(), 300, UniformLayout::delaunay, {}, 1);
  const PatternLocator locator(mesh);
  RandomStream random(2, "points");
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p(0.2 * random.uniform(), 0.2 * random.uniform());
    const PatternLocator::Place place = locator.locate(p);
    Eigen::Vector2d q = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(place.weights[k], 0);
      q += place.weights[k] * mesh.pattern.row(mesh.triangles(place.triangle, k)).transpose();
    }
    const bool inside = contains(plane_shapes::ell_pattern(), p);
    const double expected = inside ? 0 : nearest_on_border(plane_shapes::ell_pattern(), p).distance;
    EXPECT_NEAR((p - q).norm(), expected, 1e-12);
  }
}

TEST(OverlapArea, OfTwoHalvesOfASquareTurnedByARightAngleIsAQuarter) {
  const PlaneTriangle a{Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(1, 1)};
  const PlaneTriangle b{Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)};
  EXPECT_DOUBLE_EQ(overlap_area(a, b), 0.25);
  EXPECT_DOUBLE_EQ(overlap_area(b, a), 0.25);
  EXPECT_DOUBLE_EQ(overlap_area(a, a), 0.5);
}

TEST(OverlapArea, OfNeighboursIsZero) {
  const PlaneTriangle a{Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0), Eigen::Vector2d(1, 1)};
  const PlaneTriangle b{Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Eigen::Vector2d(0, 1)};
  EXPECT_EQ(overlap_area(a, b), 0);
}

// Two centred equilateral triangles, one turned by 60 degrees, share a regular hexagon: 2/3 of one.
TEST(OverlapArea, OfAHexagramIsTwoThirds) {
  PlaneTriangle a, b;
  for (int k = 0; k < 3; ++k) {
    const double t = 2.0943951023931953 * k;
    a[k] = {std::cos(t), std::sin(t)};
    b[k] = {-std::cos(t), -std::sin(t)};
  }
  EXPECT_NEAR(overlap_area(a, b), 2.0 / 3 * 3 * std::sqrt(3.0) / 4, 1e-14);
}

}  // namespace
}  // namespace geoprior::paper
