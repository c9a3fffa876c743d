#include "models/paper/shell/plasticity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/curvature_fit.h"
#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

/// Rolls the sheet on a cylinder along y, of this curvature.
void roll(ShellState& state, double curvature) {
  for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
    const double u = state.mesh.pattern(i, 0);
    state.x.row(i) << std::sin(curvature * u) / curvature, state.mesh.pattern(i, 1),
        (1 - std::cos(curvature * u)) / curvature;
  }
}

TEST(Plasticity, LeavesTheYieldCurvatureAsElasticPart) {
  Sheet sheet = sheets::free_sheet(0.06, 0.04);
  ShellState state = sheets::at_rest(sheet, 200);
  const double yield = 40, curvature = 100;
  roll(state, curvature);
  const ShellElements elements(state.mesh, sheet.material, BendingLaw());
  const CurvatureFit fit = fit_curvature(state.mesh.pattern, state.mesh.triangles);
  const Eigen::MatrixX3d S = shape_operators(fit, state.x);
  EXPECT_EQ(flow_plastically(elements, yield, state), state.mesh.triangle_count());
  for (int t = 0; t < state.mesh.triangle_count(); ++t) {
    const Eigen::Vector3d elastic = elements.elastic_curvature(t, state, state.x);
    EXPECT_NEAR(curvature_norm(elastic), yield, 1e-9);
    EXPECT_NEAR(state.damage[t], curvature_norm(S.row(t)) / yield - 1, 1e-9);
  }
  // Nothing more flows while the sheet stays as it is.
  const Eigen::MatrixX3d plastic = state.plastic_curvature;
  EXPECT_EQ(flow_plastically(elements, yield * (1 + 1e-12), state), 0);
  EXPECT_EQ(state.plastic_curvature, plastic);
}

TEST(Plasticity, DoesNothingBelowTheYieldCurvature) {
  Sheet sheet = sheets::free_sheet(0.06, 0.04);
  ShellState state = sheets::at_rest(sheet, 200);
  roll(state, 30);
  const ShellElements elements(state.mesh, sheet.material, BendingLaw());
  EXPECT_EQ(flow_plastically(elements, 40, state), 0);
  EXPECT_EQ(state.plastic_curvature.norm(), 0);
  EXPECT_EQ(state.damage.norm(), 0);
}

/// A strip bent to curvature k and let go rests at k - k_yield: the shape operator k - k_yield
/// across the rulings costs no energy.
TEST(Plasticity, BentStripKeepsWhatExceedsTheYield) {
  Sheet sheet = sheets::free_sheet(0.06, 0.02);
  sheet.material.yield_curvature = 40;
  ShellState state = sheets::at_rest(sheet, 120);
  roll(state, 100);
  StepperOptions options;
  options.integration = Integration::newton;
  options.plasticity = false;  // the sheet is let go at the yield, and its swing would exceed it
  ShellStepper stepper(sheet, options, 1);
  stepper.set_mesh(state);
  const ShellElements elements(state.mesh, sheet.material, BendingLaw());
  flow_plastically(elements, 40, state);
  const double before = stepper.energies(state).bending;
  sheets::advance(stepper, state, 0.01, 20);
  const CurvatureFit fit = fit_curvature(state.mesh.pattern, state.mesh.triangles);
  const Eigen::MatrixX3d S = shape_operators(fit, state.x);
  EXPECT_NEAR(S.col(0).mean(), 60, 0.02 * 60);
  EXPECT_LT(stepper.energies(state).bending, 0.01 * before);
}

TEST(Plasticity, StepperCreasesOnlyWhenAskedTo) {
  for (const bool plasticity : {false, true}) {
    Sheet sheet = sheets::free_sheet(0.06, 0.02);
    sheet.material.yield_curvature = 40;
    ShellState state = sheets::at_rest(sheet, 60);
    roll(state, 100);
    StepperOptions options;
    options.plasticity = plasticity;
    ShellStepper stepper(sheet, options, 1);
    stepper.set_mesh(state);
    sheets::advance(stepper, state, 1e-4, 1);
    EXPECT_EQ(state.damage.sum() > 0, plasticity);
  }
}

}  // namespace
}  // namespace geoprior::paper
