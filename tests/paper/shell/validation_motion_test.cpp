#include <gtest/gtest.h>

#include <cmath>

#include "models/paper/shell/lumped_mass.h"
#include "tests/paper/meshes.h"
#include "tests/paper/sheets.h"

// Conservation in the motion of a free sheet.
namespace geoprior::paper {
namespace {

struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
};

/// Of velocities `v` at places `x`.
Momentum momentum(const Eigen::VectorXd& mass, const Eigen::MatrixX3d& x,
                  const Eigen::MatrixX3d& v) {
  Momentum sum;
  for (Eigen::Index i = 0; i < mass.size(); ++i) {
    const Eigen::Vector3d p = mass[i] * v.row(i).transpose();
    sum.linear += p;
    sum.angular += x.row(i).transpose().cross(p);
  }
  return sum;
}

StepperOptions newton() {
  StepperOptions options;
  options.integration = Integration::newton;
  options.plasticity = false;
  options.newton_iterations = 300;
  return options;
}

/// A sheet bent to a cylinder and let go.
ShellState released(double size) {
  ShellMesh mesh = meshes::delaunay(8, 8, size, size, 4);
  mesh.pattern.array() -= size / 2;
  ShellState state = meshes::flat_state(mesh);
  state.x = meshes::rolled(mesh.pattern, 5, 0.3);
  return state;
}

TEST(FreeFlight, VibratingSheetsNeverGainEnergy) {
  const Sheet sheet = sheets::free_sheet(0.2, 0.2);
  for (const Integration integration : {Integration::linear, Integration::newton}) {
    StepperOptions options = newton();
    options.integration = integration;
    ShellStepper stepper(sheet, options, 1);
    ShellState state = released(0.2);
    stepper.set_mesh(state);
    const double start = sheets::total(stepper.energies(state));
    const double bending = stepper.energies(state).bending;
    double before = start, most_kinetic = 0;
    for (int k = 0; k < 30; ++k) {
      sheets::advance(stepper, state, 1e-3, 1);
      const ShellEnergies now = stepper.energies(state);
      EXPECT_LE(sheets::total(now), before + 1e-9 * start) << k;
      before = sheets::total(now);
      most_kinetic = std::max(most_kinetic, now.kinetic);
    }
    EXPECT_GT(most_kinetic, 0.1 * bending);  // it does vibrate
  }
}

// Implicit Euler keeps the linear momentum to the tolerance of the solver. Of the angular momentum
// it loses sum m v1 x v0 dt, no more and no less, since forces at x1 have no torque about it: about
// (omega dt)^2 a step of a spinning sheet.
TEST(FreeFlight, KeepsLinearMomentumAndLosesAngularMomentumAsImplicitEulerDoes) {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.material.thickness = 1e-3;  // card: Newton then converges in a few iterations
  sheet.material.area_density = 0.8;
  ShellStepper stepper(sheet, newton(), 1);
  ShellState state = released(0.2);
  const Eigen::Vector3d spin(3, -5, 8), drift(0.4, 0.1, -0.2);
  for (Eigen::Index i = 0; i < state.x.rows(); ++i)
    state.v.row(i) = drift + spin.cross(Eigen::Vector3d(state.x.row(i)));
  stepper.set_mesh(state);
  const Eigen::VectorXd mass = lumped_masses(state.mesh, sheet.material.area_density);
  const double dt = 2e-4;
  for (int k = 0; k < 20; ++k) {
    const ShellState old = state;
    ASSERT_EQ(sheets::advance(stepper, state, dt, 1).halvings, 0);
    const Momentum before = momentum(mass, old.x, old.v), after = momentum(mass, state.x, state.v);
    EXPECT_LT((after.linear - before.linear).norm(), 1e-8 * before.linear.norm()) << k;
    const Eigen::Vector3d lost = dt * momentum(mass, state.v, old.v).angular;
    EXPECT_LT((after.angular - before.angular - lost).norm(), 1e-8 * before.angular.norm()) << k;
    EXPECT_GT(lost.norm(), 1e-6 * before.angular.norm());
  }
}

}  // namespace
}  // namespace geoprior::paper
