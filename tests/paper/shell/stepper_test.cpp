#include "models/paper/shell/stepper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "models/paper/sheet/handle_map.h"
#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

StepperOptions with(Integration integration) {
  StepperOptions options;
  options.integration = integration;
  return options;
}

ShellStepper stepper_for(const Sheet& sheet, const ShellState& state,
                         const StepperOptions& options) {
  ShellStepper stepper(sheet, options, 1);
  stepper.set_mesh(state);
  return stepper;
}

/// A sheet bent between two opposite edges that approach each other.
Sheet sheet_to_bend() {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.gravity = {0, 0, -9.81};
  sheet.imperfection = 1e-4;
  for (const double side : {-1.0, 1.0}) {
    Handle handle;
    handle.name = side < 0 ? "left" : "right";
    handle.segment = {{side * 0.1, -0.1}, {side * 0.1, 0.1}};
    Keyframe end;
    end.time = 0.5;
    end.shift = {-side * 0.03, 0, 0};
    handle.motion = Trajectory{{Keyframe{}, end}};
    sheet.handles.push_back(handle);
  }
  return sheet;
}

/// x_n = g dt^2 n (n + 1) / 2, the exact solution of implicit Euler's recursion.
TEST(Stepper, FallsAsImplicitEulerDoes) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheets::free_sheet(0.3, 0.2);
    sheet.gravity = {1, 2, -9.81};
    ShellState state = sheets::at_rest(sheet, 60, UniformLayout::delaunay);
    const Eigen::MatrixX3d start = state.x;
    ShellStepper stepper = stepper_for(sheet, state, with(integration));
    const int n = 40;
    const double dt = 0.005;
    sheets::advance(stepper, state, dt, n);
    const Eigen::RowVector3d fall = (dt * dt * n * (n + 1) / 2) * sheet.gravity.transpose();
    EXPECT_LT((state.x - start).rowwise().operator-(fall).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_NEAR(state.time, n * dt, 1e-12);
  }
}

TEST(Stepper, FreeFlightKeepsTheMomentum) {
  for (const Integration integration : sheets::kIntegrations) {
    const Sheet sheet = sheets::free_sheet(0.3, 0.2);
    ShellState state = sheets::at_rest(sheet, 80, UniformLayout::delaunay);
    RandomStream random(4, "velocities");
    for (Eigen::Index i = 0; i < state.v.size(); ++i) state.v.data()[i] = random.normal();
    ShellStepper stepper = stepper_for(sheet, state, with(integration));
    // The momentum is read off the rate of the gravity energy: m g.v for unit g in each direction.
    const auto centre = [&] {
      Eigen::Vector3d c;
      for (int axis = 0; axis < 3; ++axis) {
        Sheet pulled = sheet;
        pulled.gravity = -Eigen::Vector3d::Unit(axis);
        c[axis] = stepper_for(pulled, state, {}).energies(state).gravity;
      }
      return Eigen::Vector3d(c / sheets::mass(sheet, state));
    };
    const double dt = 1e-3;
    const Eigen::Vector3d x0 = centre();
    sheets::advance(stepper, state, dt, 1);
    const Eigen::Vector3d x1 = centre();
    sheets::advance(stepper, state, dt, 20);
    const Eigen::Vector3d x21 = centre();
    EXPECT_GT((x1 - x0).norm(), 1e-5);
    EXPECT_LT((x21 - x1 - 20 * (x1 - x0)).norm(), 1e-11);
  }
}

TEST(Stepper, HandleForceOfAHangingSheetIsItsWeight) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheets::free_sheet(0.3, 0.2);
    sheet.gravity = {0, -9.81, 0};
    sheet.material.damping = 0.02;
    sheet.handles.push_back(sheets::point_handle("top", {{-0.15, 0.1}, {0.15, 0.1}}));
    ShellState state = sheets::at_rest(sheet, 100);
    ShellStepper stepper = stepper_for(sheet, state, with(integration));
    const StepReport report = sheets::advance(stepper, state, 0.02, 300);
    const double weight = 9.81 * sheets::mass(sheet, state);
    EXPECT_NEAR(report.handle_force[0].y(), weight, 1e-6 * weight);
    EXPECT_NEAR(report.handle_force[0].x(), 0, 1e-6 * weight);
    EXPECT_NEAR(report.handle_work, 0, 1e-12);
  }
}

/// Every vertex is held and lifted: work = m g h + kinetic energy gained, whatever the elasticity.
TEST(Stepper, LiftingTakesTheWorkOfTheWeight) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheets::free_sheet(0.2, 0.2);
    sheet.gravity = {0, 0, -9.81};
    Handle handle = sheets::point_handle("all", {{0, 0}});
    handle.disc_radius = 1;
    Keyframe end;
    end.time = 1;
    end.shift = {0.1, 0, 0.3};
    handle.motion = Trajectory{{Keyframe{}, end}};
    // A disc of the sheet's size covers every vertex; its rim need not be in the mesh.
    ShellState state = sheets::at_rest(sheet, 60);
    sheet.handles.push_back(handle);
    ShellStepper stepper = stepper_for(sheet, state, with(integration));
    RunContext context;
    double work = 0;
    for (int k = 0; k < 100; ++k) work += stepper.step(state, 0.01, context).handle_work;
    // Implicit Euler loses m (dv)^2 / 2 a step: sum of 1/2 m a^2 dt^2 over the steps.
    const double m = sheets::mass(sheet, state);
    EXPECT_NEAR(work, m * 9.81 * 0.3, 0.02 * m * 9.81 * 0.3);
    EXPECT_NEAR(state.x.col(2).mean(), 0.3, 1e-12);
  }
}

/// Implicit Euler loses energy: what the sheet has afterwards is at most what it had and was given.
TEST(Stepper, EnergyDoesNotGrowBeyondTheHandlesWork) {
  Sheet sheet = sheet_to_bend();
  ShellState state = sheets::at_rest(sheet, 100);
  StepperOptions options = with(Integration::newton);
  options.plasticity = false;
  ShellStepper stepper = stepper_for(sheet, state, options);
  RunContext context;
  double energy = sheets::total(stepper.energies(state));
  for (int k = 0; k < 100; ++k) {
    const StepReport report = stepper.step(state, 0.005, context);
    const double after = sheets::total(stepper.energies(state));
    EXPECT_LE(after, energy + report.handle_work + 1e-9) << "step " << k;
    energy = after;
  }
}

TEST(Stepper, DeadLoadAcceleratesByForceOverMass) {
  Sheet sheet = sheets::free_sheet(0.2, 0.1);
  Handle handle;
  handle.name = "pull";
  handle.segment = {{0.1, -0.05}, {0.1, 0.05}};
  handle.force = Eigen::Vector3d(0.02, 0, 0.001);
  handle.active = {{0, 0.1}};
  sheet.handles.push_back(handle);
  ShellState state = sheets::at_rest(sheet, 60);
  ShellStepper stepper = stepper_for(sheet, state, with(Integration::newton));
  const double m = sheets::mass(sheet, state);
  Sheet pulled = sheet;
  pulled.gravity = {-1, 0, 0};
  ShellStepper scale = stepper_for(pulled, state, {});
  const double start = scale.energies(state).gravity / m;
  const int n = 10;
  const double dt = 0.01;
  const StepReport report = sheets::advance(stepper, state, dt, n);
  EXPECT_EQ(report.handle_force[0], *handle.force);
  const double expected = 0.02 / m * dt * dt * n * (n + 1) / 2;
  EXPECT_NEAR(scale.energies(state).gravity / m - start, expected, 1e-6 * expected);
  EXPECT_EQ(sheets::advance(stepper, state, dt, 1).handle_force[0], Eigen::Vector3d::Zero());
}

/// The trapezoidal rule is exact for force and moment: 1 N along a segment of 1 m, arm 1/2 m.
TEST(HandleMap, SpreadsALoadEvenlyOverUnevenVertices) {
  Sheet sheet = sheets::free_sheet(1, 1);
  Handle handle;
  handle.name = "edge";
  handle.segment = {{-0.5, 0.5}, {0.5, 0.5}};
  handle.force = Eigen::Vector3d(0, 0, 1);
  sheet.handles.push_back(handle);
  ShellMesh mesh;
  mesh.pattern.resize(6, 2);
  mesh.pattern << -0.5, -0.5, 0.5, -0.5, 0.5, 0.5, 0.4, 0.5, -0.3, 0.5, -0.5, 0.5;
  mesh.triangles.resize(4, 3);
  mesh.triangles << 0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5;
  Eigen::MatrixX3d forces = Eigen::MatrixX3d::Zero(6, 3);
  HandleMap(sheet, resting_state(sheet, mesh, 1), 1).add_loads(sheet, 0, forces);
  EXPECT_NEAR(forces.col(2).sum(), 1, 1e-14);
  EXPECT_NEAR(forces.col(2).dot(mesh.pattern.col(0)), 0, 1e-14);
  EXPECT_NEAR(forces(2, 2), 0.05, 1e-14);
}

TEST(HandleMap, NamesAHandleThatNoVertexLiesOn) {
  Sheet sheet = sheets::free_sheet(1, 1);
  const ShellState state = sheets::at_rest(sheet, 8);
  sheet.handles.push_back(sheets::point_handle("nowhere", {{0.123, 0.234}}));
  ShellStepper stepper(sheet, {}, 1);
  try {
    stepper.set_mesh(state);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("nowhere"));
  }
}

/// Held vertices stay where they are put; the rows of the system stay when a handle lets go.
TEST(Stepper, HandlesSwitchWithoutANewAnalysis) {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.gravity = {0, 0, -9.81};
  Handle handle = sheets::point_handle("corner", {{-0.1, -0.1}});
  handle.active = {{0, 0.1}};
  sheet.handles.push_back(handle);
  ShellState state = sheets::at_rest(sheet, 60);
  ShellStepper stepper = stepper_for(sheet, state, {});
  const auto held = stepper.held(0.05);
  ASSERT_EQ(held.size(), 1U);
  const Eigen::RowVector3d place = state.x.row(held[0].vertex);
  const long nonzeros = stepper.factor_nonzeros();
  EXPECT_GT(nonzeros, 0);  // known from the analysis, before the first step
  sheets::advance(stepper, state, 0.01, 10);
  EXPECT_EQ(state.x.row(held[0].vertex), place);
  EXPECT_TRUE(stepper.held(0.2).empty());
  sheets::advance(stepper, state, 0.01, 5);
  EXPECT_LT(state.x(held[0].vertex, 2), place.z() - 1e-3);
  EXPECT_EQ(stepper.factor_nonzeros(), nonzeros);
}

TEST(Stepper, SameBitsOnOneAndTwoThreads) {
  const Sheet sheet = sheet_to_bend();
  for (const Integration integration : sheets::kIntegrations) {
    for (const LinearSolver solver :
         {LinearSolver::eigen, LinearSolver::cholmod, LinearSolver::supernodal}) {
      const auto run = [&](int threads) {
        ShellState state = sheets::at_rest(sheet, 300);
        StepperOptions options = with(integration);
        options.solver = solver;
        with_threads(threads, [&] {
          ShellStepper stepper = stepper_for(sheet, state, options);
          sheets::advance(stepper, state, 0.005, 2);  // the second from a bent sheet
        });
        return state;
      };
      const ShellState one = run(1), two = run(2);
      EXPECT_EQ(one.x, two.x);
      EXPECT_EQ(one.v, two.v);
    }
  }
}

/// One step of the same state: the solvers differ by round-off only, 1e-10 of what moves.
TEST(Stepper, LinearSolversAgree) {
  const Sheet sheet = sheet_to_bend();
  ShellState start = sheets::at_rest(sheet, 300);
  ShellStepper first = stepper_for(sheet, start, {});
  sheets::advance(first, start, 0.005, 20);
  std::vector<ShellState> after;
  for (const LinearSolver solver :
       {LinearSolver::eigen, LinearSolver::cholmod, LinearSolver::supernodal}) {
    StepperOptions options;
    options.solver = solver;
    ShellState state = start;
    ShellStepper stepper = stepper_for(sheet, state, options);
    sheets::advance(stepper, state, 0.005, 1);
    after.push_back(state);
  }
  const double moved = (after[0].x - start.x).norm();
  EXPECT_LT((after[0].x - after[1].x).norm(), 1e-10 * moved);
  EXPECT_LT((after[0].x - after[2].x).norm(), 1e-10 * moved);
}

TEST(Stepper, NewtonReachesTheToleranceAskedFor) {
  const Sheet sheet = sheet_to_bend();
  ShellState state = sheets::at_rest(sheet, 200);
  const StepperOptions options = with(Integration::newton);
  ShellStepper stepper = stepper_for(sheet, state, options);
  RunContext context;
  for (int k = 0; k < 60; ++k) {
    const StepReport report = stepper.step(state, 0.005, context);
    EXPECT_LE(report.residual, options.newton_tolerance) << "step " << k;
  }
  EXPECT_GT(state.x.col(2).maxCoeff() - state.x.col(2).minCoeff(), 0.02) << "the sheet buckled";
}

/// The linear step is the first iteration of Newton's method: the difference falls with dt^2 or
/// faster.
TEST(Stepper, LinearStepApproachesImplicitEuler) {
  const Sheet sheet = sheet_to_bend();
  ShellState start = sheets::at_rest(sheet, 100);
  ShellStepper first = stepper_for(sheet, start, with(Integration::newton));
  sheets::advance(first, start, 0.005, 60);
  std::array<double, 2> difference{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double dt = k == 0 ? 1e-4 : 5e-5;
    std::array<ShellState, 2> after{start, start};
    for (std::size_t i = 0; i < 2; ++i) {
      StepperOptions options = with(sheets::kIntegrations[i]);
      options.newton_tolerance = 1e-11;
      ShellStepper stepper = stepper_for(sheet, after[i], options);
      sheets::advance(stepper, after[i], dt, 1);
    }
    difference[k] = (after[0].x - after[1].x).norm();
  }
  EXPECT_GT(difference[0], 0);
  EXPECT_GT(difference[0] / difference[1], 4);
}

TEST(Stepper, DampingTakesStretchingEnergyAndLeavesRigidMotion) {
  std::array<double, 2> kinetic{};
  for (std::size_t k = 0; k < 2; ++k) {
    Sheet sheet = sheets::free_sheet(0.2, 0.2);
    sheet.material.damping = k == 0 ? 0 : 1e-3;
    ShellState state = sheets::at_rest(sheet, 60);
    state.v.rowwise() = Eigen::RowVector3d(0, 0, 1);
    state.v.col(0) += state.mesh.pattern.col(0);  // a stretching mode
    ShellStepper stepper = stepper_for(sheet, state, with(Integration::newton));
    sheets::advance(stepper, state, 1e-6, 3);
    EXPECT_LT((state.v.col(2).array() - 1).abs().maxCoeff(), 1e-9);
    kinetic[k] = state.v.leftCols<2>().squaredNorm();
  }
  EXPECT_LT(kinetic[1], 0.5 * kinetic[0]);
}

/// Half a turn in one step would turn triangles over; two quarters would still, eighths do not.
TEST(Stepper, HalvesAStepThatTurnsTrianglesOver) {
  Sheet sheet = sheets::free_sheet(0.1, 0.1);
  Handle handle = sheets::point_handle("all", {{0, 0}});
  handle.disc_radius = 1;
  ShellState state = sheets::at_rest(sheet, 16);
  Keyframe end;
  end.time = 0.01;
  end.turn = Eigen::AngleAxisd(0.9 * std::numbers::pi, Eigen::Vector3d::UnitX());
  handle.motion = Trajectory{{Keyframe{}, end}};
  sheet.handles.push_back(handle);
  for (const Integration integration : sheets::kIntegrations) {
    ShellState turned = state;
    ShellStepper stepper = stepper_for(sheet, turned, with(integration));
    const StepReport report = sheets::advance(stepper, turned, 0.01, 1);
    EXPECT_GE(report.halvings, 1);
    EXPECT_GE(report.newton_iterations, integration == Integration::linear ? 3 : 0);
    EXPECT_DOUBLE_EQ(turned.time, 0.01);
    for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
      const Eigen::Vector3d expected = end.turn * Eigen::Vector3d(state.x.row(i));
      EXPECT_LT((turned.x.row(i).transpose() - expected).norm(), 1e-12);
    }
  }
}

/// A slack sheet has no tension that would hold back a corner which a hand pulls out of its plane,
/// and the linear forces of a whole step do not learn of it: it would end with 62 kJ. The hand,
/// whose spring all energy comes from, has 6 J.
TEST(Stepper, HalvesAStepThatPullsASlackSheetTooFar) {
  Sheet sheet = sheets::free_sheet(0.1, 0.1);
  Handle held;
  held.name = "edge";
  held.segment = {{-0.05, -0.05}, {-0.05, 0.05}};
  held.motion = Trajectory{{Keyframe{}}};
  Keyframe up;
  up.shift = {0, 0, 0.2};
  Handle pulling = sheets::point_handle("corner", {{0.05, 0.05}}, {up});
  pulling.stiffness = 300;
  sheet.handles = {held, pulling};
  const double given = 300 * 0.2 * 0.2 / 2;
  for (const Integration integration : sheets::kIntegrations) {
    ShellState state = sheets::at_rest(sheet, 60);
    ShellStepper stepper = stepper_for(sheet, state, with(integration));
    ASSERT_NEAR(stepper.energies(state).hands, given, 1e-9);
    const StepReport report = sheets::advance(stepper, state, 0.005, 1);
    EXPECT_GE(report.halvings, 1);
    const ShellEnergies after = stepper.energies(state);
    EXPECT_LT(after.membrane + after.bending + after.kinetic + after.hands, given);
    EXPECT_GT(state.x.col(2).maxCoeff(), 0.01) << "the corner gave way";
  }
}

TEST(Stepper, GivesUpWithTheTimeAndLeavesTheStateAsItWas) {
  for (const Integration integration : sheets::kIntegrations) {
    Sheet sheet = sheet_to_bend();
    sheet.handles[0].motion->keys[1].shift.x() = 1e200;
    ShellState state = sheets::at_rest(sheet, 60);
    StepperOptions options = with(integration);
    ShellStepper stepper = stepper_for(sheet, state, options);
    const ShellState before = state;
    RunContext context;
    try {
      stepper.step(state, 0.25, context);
      FAIL();
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("time 0.0"));
      EXPECT_THAT(error.what(), testing::HasSubstr("8 halvings"));
    }
    EXPECT_EQ(state.x, before.x);
    EXPECT_EQ(state.v, before.v);
    EXPECT_EQ(state.time, before.time);
  }
}

TEST(Stepper, DoesNotStepFromNaN) {
  const Sheet sheet = sheet_to_bend();
  for (const Integration integration : sheets::kIntegrations) {
    ShellState state = sheets::at_rest(sheet, 60);
    ShellStepper stepper = stepper_for(sheet, state, with(integration));
    state.v(7, 1) = std::numeric_limits<double>::quiet_NaN();
    RunContext context;
    EXPECT_THROW(stepper.step(state, 0.005, context), Error);
    EXPECT_EQ(state.time, 0);
  }
}

TEST(Stepper, NamesATriangleTurnedOverInThePattern) {
  const Sheet sheet = sheets::free_sheet(0.2, 0.2);
  ShellState state = sheets::at_rest(sheet, 16);
  std::swap(state.mesh.triangles(5, 0), state.mesh.triangles(5, 1));
  ShellStepper stepper(sheet, {}, 1);
  try {
    stepper.set_mesh(state);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("triangle 5"));
  }
}

TEST(Stepper, RefusesAStateOfAnotherMeshAndNoMesh) {
  const Sheet sheet = sheets::free_sheet(0.2, 0.2);
  ShellState state = sheets::at_rest(sheet, 16);
  ShellState other = sheets::at_rest(sheet, 60);
  RunContext context;
  ShellStepper stepper(sheet, {}, 1);
  EXPECT_THROW(stepper.step(state, 0.01, context), Error);
  stepper.set_mesh(state);
  EXPECT_THROW(stepper.step(other, 0.01, context), Error);
  EXPECT_THROW(stepper.step(state, 0, context), Error);
}

}  // namespace
}  // namespace geoprior::paper
