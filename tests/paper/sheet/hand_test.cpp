// Hands that give, and paper with a grain.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/curvature_fit.h"
#include "metrics/isometry/shell_energy.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/handle_map.h"
#include "models/paper/sheet/valid.h"
#include "models/paper/shell/stepper.h"
#include "models/paper/tear/lips.h"
#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector3d;

/// A strip between two hands that pull it 2 cm farther apart than it is long.
Sheet strip_between_hands(double stiffness) {
  Sheet sheet = sheets::free_sheet(0.2, 0.05);
  sheet.imperfection = 0;
  for (const double side : {-1.0, 1.0}) {
    Handle handle;
    handle.name = side < 0 ? "left" : "right";
    handle.segment = {{side * 0.1, -0.025}, {side * 0.1, 0.025}};
    Keyframe start, end;
    end.time = 1;
    end.shift = Vector3d(side * 0.01, 0, 0);
    handle.motion = Trajectory{{start, end}};
    handle.stiffness = stiffness;
    sheet.handles.push_back(handle);
  }
  return sheet;
}

class HandsThatGive : public testing::TestWithParam<Integration> {};

TEST_P(HandsThatGive, PullAsTheSpringsAndTheStripInARow) {
  const double k = 100;
  const Sheet sheet = strip_between_hands(k);
  const ShellState start =
      resting_state(sheet, uniform_mesh(sheet.pattern, 60, UniformLayout::equilateral, {}, 1), 1);
  ShellState state = start;
  StepperOptions options;
  options.integration = GetParam();
  ShellStepper stepper(sheet, options, 1);
  stepper.set_mesh(state);
  RunContext context(1);
  double work = 0;
  StepReport report;
  for (int i = 0; i < 300; ++i) {
    state.time = 0.005 * i;
    report = stepper.step(state, 0.005, context);
    work += report.handle_work;
  }
  // Two springs, and a strip of stiffness E h w / l between them.
  const double strip = 4.5e9 * 1e-4 * 0.05 / 0.2;
  const double force = 0.02 / (2 / k + 1 / strip);
  EXPECT_NEAR(report.handle_force[1].x(), force, 1e-3 * force);
  EXPECT_NEAR(report.handle_force[0].x(), -force, 1e-3 * force);
  const ShellEnergies energies = stepper.energies(state);
  EXPECT_NEAR(energies.hands, force * force / k, 2e-3 * force * force / k);
  // What the hands did is there as energy; an implicit step of a linear load adds half of the last
  // step's.
  EXPECT_NEAR(work, energies.strain(), 0.02 * work);
}

INSTANTIATE_TEST_SUITE_P(Steps, HandsThatGive,
                         testing::Values(Integration::linear, Integration::newton));

TEST(HandsThatGive, NeedKeys) {
  Sheet sheet = strip_between_hands(100);
  sheet.handles[0].motion.reset();
  sheet.handles[0].force = Vector3d(1, 0, 0);
  EXPECT_THAT([&] { require_valid(sheet, "scene"); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("stiffness")));
  sheet = strip_between_hands(0);
  EXPECT_THAT([&] { require_valid(sheet, "scene"); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("stiffness")));
}

// A finger at the mouth of a cut holds the lip that is with it, wherever the other one has gone.
TEST(HandleMap, AFingerKeepsTheLipThatIsWithIt) {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.pattern.cuts = {{{0, -0.1}, {0, 0}}};
  Keyframe still;
  sheet.handles.push_back(sheets::point_handle("finger", {{0, -0.1}}, {still}));
  ShellState state = resting_state(
      sheet, uniform_mesh(sheet.pattern, 60, UniformLayout::equilateral, {{0, -0.1}, {0, 0}}, 1),
      1);
  std::vector<int> lips;
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    if ((state.mesh.pattern.row(v) - Eigen::RowVector2d(0, -0.1)).norm() < 1e-9) lips.push_back(v);
  }
  ASSERT_EQ(lips.size(), 2U);
  for (const int gone : lips) {
    ShellState torn = state;
    torn.x.row(gone) += Eigen::RowVector3d(0, 0, -100);
    std::vector<HandleMap::Target> targets;
    HandleMap(sheet, torn, 1).targets(sheet, 0, targets);
    ASSERT_EQ(targets.size(), 1U);
    EXPECT_NE(targets[0].vertex, gone);
  }
}

/// Energies of a sheet rolled about the v axis, of the element and of the metric, with fibres in a
/// direction.
std::pair<double, double> rolled(double grain_deg, double along) {
  Sheet sheet = sheets::free_sheet(0.2, 0.1);
  sheet.material.grain_deg = grain_deg;
  sheet.material.along = along;
  ShellState state =
      resting_state(sheet, uniform_mesh(sheet.pattern, 800, UniformLayout::equilateral, {}, 1), 1);
  const double radius = 0.1;
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    const double angle = state.mesh.pattern(v, 0) / radius;
    state.x.row(v) << radius * std::sin(angle), state.mesh.pattern(v, 1),
        radius * (1 - std::cos(angle));
  }
  ShellStepper stepper(sheet, {}, 1);
  stepper.set_mesh(state);
  const PaperMaterial& m = sheet.material;
  const double measured =
      bending_energy(fit_curvature(state.mesh.pattern, state.mesh.triangles), state.x,
                     Eigen::MatrixX3d::Zero(state.mesh.triangle_count(), 3),
                     {m.membrane_stiffness(), m.bending_stiffness(), m.poisson_ratio,
                      grain_deg * std::numbers::pi / 180, along});
  return {stepper.energies(state).bending, measured};
}

TEST(Grain, MakesASheetStifferAlongTheFibres) {
  const auto even = rolled(0, 1), along = rolled(0, 3), across = rolled(90, 3);
  EXPECT_NEAR(along.first / even.first, 3, 0.02);
  EXPECT_NEAR(across.first / even.first, 1, 0.02);
  EXPECT_NEAR(along.second / even.second, 3, 0.02);
  EXPECT_NEAR(across.second / even.second, 1, 0.02);
  // cos^4 of 60 degrees of what the fibres add.
  const auto oblique = rolled(60, 3);
  EXPECT_NEAR(oblique.first / even.first, 1 + 2.0 / 16, 0.02);
}

TEST(Grain, NeedsADirection) {
  Sheet sheet = sheets::free_sheet(0.2, 0.1);
  sheet.material.along = 2;
  EXPECT_THAT([&] { require_valid(sheet, "scene"); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("grain_deg")));
}

}  // namespace
}  // namespace geoprior::paper
