#include "solvers/paper/shell/isometry_projection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/meshing/ruling_mesh.h"
#include "tests/paper/sheet/hybrid_fixture.h"

namespace geoprior::paper {
namespace {

/// A sheet of 0.2 m by 0.2 m with upright rulings every 0.02 m, rolled on a cylinder.
ShellState rolled(double radius) {
  const Pattern pattern = rectangle_pattern(0.2, 0.2);
  const std::vector<Eigen::Vector2d> anchors;
  PaperStructure structure;
  const RulingEditor editor(pattern, anchors, {}, structure);
  for (int k = -4; k <= 4; ++k)
    editor.structure().rulings.push_back(*editor.chord({0.02 * k, 0}, {0, 1}));
  ShellState state;
  state.mesh = mesh_structure(structure, pattern, anchors, {}).mesh;
  const int n = state.mesh.vertex_count();
  state.x.resize(n, 3);
  state.v = Eigen::MatrixX3d::Zero(n, 3);
  for (int i = 0; i < n; ++i) {
    const double u = state.mesh.pattern(i, 0);
    state.x.row(i) << radius * std::sin(u / radius), state.mesh.pattern(i, 1),
        radius * std::cos(u / radius);
  }
  return state;
}

/// Largest principal Green strain of a triangle, in modulus, from the stretches of its map.
double largest_strain(const ShellState& state) {
  double most = 0;
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    const Eigen::Vector2d sigma = stretch(state, f).sigma;
    most = std::max(most, ((sigma.array().square() - 1) / 2).abs().maxCoeff());
  }
  return most;
}

TEST(IsometryProjection, UndoesTheShorteningOfChordsInThreeSteps) {
  ShellState state = rolled(0.05);
  IsometryProjector projector(state.mesh, std::vector<bool>(state.x.rows(), false));
  const Eigen::MatrixX3d before = state.x;
  // A chord over the arc s / r = 0.4 is shorter by the ratio q = sin(0.2) / 0.2: G = (q^2 - 1) / 2.
  const double q = std::sin(0.2) / 0.2;
  const ProjectionReport report = projector.project(state, {3, 1e-6});
  EXPECT_NEAR(report.strain_before, (1 - q * q) / 2, 1e-6);
  EXPECT_LE(report.strain_after, 1e-6);
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = state.mesh.triangles(f, k), b = state.mesh.triangles(f, (k + 1) % 3);
      EXPECT_NEAR((state.x.row(b) - state.x.row(a)).norm() /
                      (state.mesh.pattern.row(b) - state.mesh.pattern.row(a)).norm(),
                  1, 2e-6);
    }
  }
  // It stays near: the shape only has to grow by that share of its size.
  EXPECT_LE((state.x - before).rowwise().norm().maxCoeff(), 0.02 * 0.1);
}

TEST(IsometryProjection, LeavesHeldVerticesAndRigidMotionsAlone) {
  ShellState state = rolled(0.05);
  std::vector<bool> held(state.x.rows(), false);
  held[0] = held[5] = true;
  state.v.rowwise() = Eigen::RowVector3d(1, -2, 3);
  IsometryProjector projector(state.mesh, held);
  const Eigen::RowVector3d first = state.x.row(0), fifth = state.x.row(5);
  projector.project(state, {4, 1e-6});
  EXPECT_EQ(state.x.row(0), first);
  EXPECT_EQ(state.x.row(5), fifth);
  EXPECT_LE((state.v.rowwise() - Eigen::RowVector3d(1, -2, 3)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(IsometryProjection, NeverAddsKineticEnergy) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    ShellState state = rolled(0.05);
    RandomStream random(seed);
    for (int i = 0; i < state.v.rows(); ++i) {
      for (int k = 0; k < 3; ++k) {
        state.v(i, k) = random.normal();
        state.x(i, k) += 1e-4 * random.normal();
      }
    }
    Eigen::VectorXd mass = Eigen::VectorXd::Zero(state.x.rows());
    for (int f = 0; f < state.mesh.triangle_count(); ++f) {
      const Eigen::RowVector2d a = state.mesh.pattern.row(state.mesh.triangles(f, 0));
      const Eigen::RowVector2d b = state.mesh.pattern.row(state.mesh.triangles(f, 1)) - a;
      const Eigen::RowVector2d c = state.mesh.pattern.row(state.mesh.triangles(f, 2)) - a;
      for (int k = 0; k < 3; ++k) {
        mass[state.mesh.triangles(f, k)] += (b.x() * c.y() - b.y() * c.x()) / 6;
      }
    }
    const auto energy = [&] { return mass.dot(state.v.rowwise().squaredNorm()); };
    const double before = energy();
    IsometryProjector projector(state.mesh, std::vector<bool>(state.x.rows(), false));
    projector.project(state, {6, 1e-6});
    EXPECT_LT(largest_strain(state), 1e-5);
    EXPECT_LT(energy(), before);
  }
}

TEST(IsometryProjection, EndsAtALeastSquaresFitWhereNoIsometryExists) {
  ShellState state = rolled(0.05);
  // Two corners of one short side, 0.2 m apart in the pattern, pulled 0.22 m apart.
  std::vector<bool> held(state.x.rows(), false);
  held[0] = held[3] = true;
  state.x.row(0) += Eigen::RowVector3d(0, -0.01, 0);
  state.x.row(3) += Eigen::RowVector3d(0, 0.01, 0);
  IsometryProjector projector(state.mesh, held);
  const ProjectionReport report = projector.project(state, {10, 1e-6});
  EXPECT_NEAR(report.strain_after, largest_strain(state), 1e-12);
  // No way along the border from the one to the other is shorter than 0.22 m: somewhere the strain
  // is at least (1.1^2 - 1) / 2. A fit spreads it, as the whole side does when it is stretched
  // alone.
  EXPECT_GE(largest_strain(state), (1.1 * 1.1 - 1) / 2);
  EXPECT_LT(largest_strain(state), 0.2);
}

}  // namespace
}  // namespace geoprior::paper
